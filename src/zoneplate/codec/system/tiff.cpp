// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/system/tiff.h"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <bit>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <type_traits>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/system/in_child.h"
#include "zoneplate/image/half.h"

namespace zoneplate {
namespace {

using View = std::span<const std::uint8_t>;

/// The functions of libtiff.
struct TiffLibrary {
  SharedLibrary library;
  decltype(&TIFFOpenOptionsAlloc) make_options = library.find("TIFFOpenOptionsAlloc");
  decltype(&TIFFOpenOptionsFree) free_options = library.find("TIFFOpenOptionsFree");
  decltype(&TIFFOpenOptionsSetMaxSingleMemAlloc) limit_memory = library.find("TIFFOpenOptionsSetMaxSingleMemAlloc");
  decltype(&TIFFOpenOptionsSetErrorHandlerExtR) on_error = library.find("TIFFOpenOptionsSetErrorHandlerExtR");
  decltype(&TIFFOpenOptionsSetWarningHandlerExtR) on_warning = library.find("TIFFOpenOptionsSetWarningHandlerExtR");
  decltype(&TIFFClientOpenExt) open = library.find("TIFFClientOpenExt");
  decltype(&TIFFClose) close = library.find("TIFFClose");
  decltype(&TIFFGetField) field = library.find("TIFFGetField");
  decltype(&TIFFGetFieldDefaulted) field_or_default = library.find("TIFFGetFieldDefaulted");
  decltype(&TIFFSetField) set_field = library.find("TIFFSetField");
  decltype(&TIFFIsTiled) is_tiled = library.find("TIFFIsTiled");
  decltype(&TIFFTileSize64) tile_size = library.find("TIFFTileSize64");
  decltype(&TIFFStripSize64) strip_size = library.find("TIFFStripSize64");
  decltype(&TIFFTileRowSize64) tile_row_size = library.find("TIFFTileRowSize64");
  decltype(&TIFFScanlineSize64) row_size = library.find("TIFFScanlineSize64");
  decltype(&TIFFComputeTile) tile_number = library.find("TIFFComputeTile");
  decltype(&TIFFComputeStrip) strip_number = library.find("TIFFComputeStrip");
  decltype(&TIFFReadEncodedTile) read_tile = library.find("TIFFReadEncodedTile");
  decltype(&TIFFReadEncodedStrip) read_strip = library.find("TIFFReadEncodedStrip");

  explicit TiffLibrary(const std::string& name) : library(Library::Tiff, name + ": a TIFF image") {}
};

/// A file in memory, as libtiff reads it, and the first error that it reports.
struct Source {
  View bytes;
  std::uint64_t at = 0;
  std::string error;
};

Source& source_of(thandle_t handle) { return *static_cast<Source*>(handle); }

tmsize_t read_source(thandle_t handle, void* out, tmsize_t size) {
  Source& source = source_of(handle);
  if (source.at >= source.bytes.size() || size <= 0) return 0;
  const auto n = std::min(static_cast<std::size_t>(size), source.bytes.size() - static_cast<std::size_t>(source.at));
  std::memcpy(out, source.bytes.data() + source.at, n);
  source.at += n;
  return static_cast<tmsize_t>(n);
}
tmsize_t write_source(thandle_t, void*, tmsize_t) { return 0; }
toff_t seek_source(thandle_t handle, toff_t offset, int whence) {
  Source& source = source_of(handle);
  source.at = offset + (whence == SEEK_CUR ? source.at : whence == SEEK_END ? source.bytes.size() : 0);
  return source.at;
}
int close_source(thandle_t) { return 0; }
toff_t size_of_source(thandle_t handle) { return source_of(handle).bytes.size(); }

[[gnu::format(printf, 4, 0)]] int keep_error(TIFF*, void* user, const char*, const char* format, va_list values) {
  std::string& error = source_of(user).error;
  char text[256];
  if (error.empty() && std::vsnprintf(text, sizeof text, format, values) > 0) error = text;
  return 1;
}
int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

/// How the samples of an image are stored.
struct Layout {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 1, samples = 1, kind = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_MINISBLACK,
                planes = PLANARCONFIG_CONTIG, compression = COMPRESSION_NONE, orientation = 1;
  std::optional<std::uint16_t> alpha;  ///< the channel
  bool is_premultiplied = false;

  bool is_light() const { return kind == SAMPLEFORMAT_IEEEFP; }
  bool is_separate() const { return planes == PLANARCONFIG_SEPARATE && samples > 1; }
  /// Channels that are used: the colours, or the grey or index.
  std::uint16_t colors() const { return is_color() ? 3 : 1; }
  bool is_color() const { return photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_YCBCR; }
};

/// A sample of a row, at most 64 bits; samples of fewer than 8 bits are packed from the highest bit.
std::uint64_t sample_at(View row, std::uint64_t index, std::uint16_t bits) {
  if (bits < 8) {
    const std::uint64_t bit = index * bits;
    return row[static_cast<std::size_t>(bit / 8)] >> (8 - bits - bit % 8) & ((1u << bits) - 1);
  }
  std::uint64_t value = 0;  // libtiff has put the bytes in the order of this processor
  const std::size_t size = bits / 8;
  std::memcpy(&value, row.subspan(static_cast<std::size_t>(index) * size, size).data(), size);
  return value;
}

class TiffReader {
 public:
  TiffReader(View bytes, const std::string& name, std::uint64_t max_pixels)
      : name_(name), max_pixels_(max_pixels), library_(name), source_{.bytes = bytes, .error = {}} {
    const std::unique_ptr<TIFFOpenOptions, decltype(library_.free_options)> options(library_.make_options(),
                                                                                    library_.free_options);
    if (!options) throw std::bad_alloc();
    // The greatest array is a strip of the whole image, or what a decompressor needs.
    const std::uint64_t greatest = 64 * max_pixels + 2 * bytes.size() + (std::uint64_t{16} << 20);
    library_.limit_memory(options.get(), static_cast<tmsize_t>(std::min(greatest, std::uint64_t{1} << 62)));
    library_.on_error(options.get(), keep_error, &source_);
    library_.on_warning(options.get(), ignore_warning, nullptr);
    // Without mapping, and without the chopping of a strip into several.
    file_ = {library_.open("", "rmc", &source_, read_source, write_source, seek_source, close_source, size_of_source,
                           nullptr, nullptr, options.get()),
             library_.close};
    if (!file_) fail_by_library();
  }

  StoredImage read() {
    read_layout();
    check_layout();
    if (layout_.photometric == PHOTOMETRIC_PALETTE) read_palette();
    const auto width = static_cast<int>(layout_.width), height = static_cast<int>(layout_.height);
    StoredImage image{.pixels = {}, .orientation = layout_.orientation};
    if (layout_.is_light())
      image.pixels = read_pixels(LinearImage(width, height, Linear{0, 0, 0, 1}));
    else if (layout_.bits == 16 || has_deep_palette_)
      image.pixels = read_pixels(Rgba16Image(width, height, Rgba16{0, 0, 0, 65535}));
    else
      image.pixels = read_pixels(Rgba8Image(width, height, Rgba8{0, 0, 0, 255}));
    return image;
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorKind::Input, fmt::format("{}: TIFF: {}", name_, cause));
  }
  [[noreturn]] void fail_by_library() const {
    std::string text = source_.error.starts_with(": ") ? source_.error.substr(2) : source_.error;  // a nameless file
    std::ranges::replace_if(
        text, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    fail("is corrupt or truncated" + (text.empty() ? "" : ": " + text));
  }

  template <class T>
  void get(std::uint32_t tag, T& value) const {
    library_.field_or_default(file_.get(), tag, &value);
  }

  void read_layout() {
    get(TIFFTAG_IMAGEWIDTH, layout_.width), get(TIFFTAG_IMAGELENGTH, layout_.height);
    get(TIFFTAG_BITSPERSAMPLE, layout_.bits), get(TIFFTAG_SAMPLESPERPIXEL, layout_.samples);
    get(TIFFTAG_SAMPLEFORMAT, layout_.kind), get(TIFFTAG_PLANARCONFIG, layout_.planes);
    get(TIFFTAG_COMPRESSION, layout_.compression), get(TIFFTAG_ORIENTATION, layout_.orientation);
    if (library_.field(file_.get(), TIFFTAG_PHOTOMETRIC, &layout_.photometric) == 0)
      layout_.photometric = layout_.samples >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
    std::uint16_t count = 0;
    const std::uint16_t* extra = nullptr;
    library_.field_or_default(file_.get(), TIFFTAG_EXTRASAMPLES, &count, &extra);
    for (std::uint16_t i = 0; i < count && !layout_.alpha; ++i)
      if (extra[i] == EXTRASAMPLE_ASSOCALPHA || extra[i] == EXTRASAMPLE_UNASSALPHA) {
        layout_.alpha = static_cast<std::uint16_t>(layout_.colors() + i);
        layout_.is_premultiplied = extra[i] == EXTRASAMPLE_ASSOCALPHA;
      }
  }

  void check_layout() {
    const Layout& l = layout_;
    if (l.width == 0 || l.height == 0 || l.width > 0x7fffffff || l.height > 0x7fffffff) fail("it has no size");
    if (std::uint64_t{l.width} * l.height > max_pixels_)
      fail(fmt::format("{} x {} pixels, at most {} are allowed", l.width, l.height, max_pixels_));
    const char* const unread = l.photometric == PHOTOMETRIC_SEPARATED ? "of inks (CMYK)"
                               : l.photometric == PHOTOMETRIC_CFA     ? "of a camera's raw sensor"
                               : l.photometric == PHOTOMETRIC_CIELAB  ? "in CIE L*a*b*"
                               : l.photometric == PHOTOMETRIC_ICCLAB  ? "in ICC L*a*b*"
                               : l.photometric == PHOTOMETRIC_ITULAB  ? "in ITU L*a*b*"
                               : l.photometric == PHOTOMETRIC_LOGL    ? "in LogL"
                               : l.photometric == PHOTOMETRIC_LOGLUV  ? "in LogLuv"
                               : l.photometric == PHOTOMETRIC_MASK    ? "a mask"
                               : l.photometric > PHOTOMETRIC_YCBCR    ? "in an unknown space"
                                                                      : nullptr;
    if (unread) fail(fmt::format("its image is {}, expected grey, RGB or a palette", unread));
    if (l.photometric == PHOTOMETRIC_YCBCR) {
      if (l.compression != COMPRESSION_JPEG || l.is_separate() || l.bits != 8)
        fail("its image is in YCbCr without JPEG, expected grey, RGB or a palette");
      library_.set_field(file_.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    }
    const bool is_code = l.kind == SAMPLEFORMAT_UINT || l.kind == SAMPLEFORMAT_VOID;
    const bool fits = is_code ? l.bits == 8 || (l.bits == 16 && l.photometric != PHOTOMETRIC_PALETTE) ||
                                    (!l.is_color() && (l.bits == 1 || l.bits == 2 || l.bits == 4))
                              : l.is_light() && l.photometric != PHOTOMETRIC_PALETTE &&
                                    (l.bits == 16 || l.bits == 32 || l.bits == 64);
    if (!fits)
      fail(fmt::format("{} bits per channel{}, expected codes of 8 or 16 bits, of 1, 2 or 4 without colours, or floats",
                       l.bits,
                       is_code        ? ""
                       : l.is_light() ? " of floats"
                                      : " of signed or complex numbers"));
    if (l.samples < l.colors()) fail(fmt::format("{} channels, expected {}", l.samples, l.colors()));
    if (l.alpha && *l.alpha >= l.samples) fail("its alpha has no channel");
  }

  void read_palette() {
    std::uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
    if (library_.field(file_.get(), TIFFTAG_COLORMAP, &red, &green, &blue) == 0) fail("has no palette");
    for (std::size_t i = 0; i < std::size_t{1} << layout_.bits; ++i)
      palette_.push_back({red[i], green[i], blue[i], 65535});
    // Some programs store 8 bits, though the format has 16.
    const bool has_bytes = std::ranges::all_of(palette_, [](Rgba16 c) { return c.r < 256 && c.g < 256 && c.b < 256; });
    for (Rgba16& c : palette_)
      if (has_bytes)
        c = {static_cast<std::uint16_t>(c.r * 257), static_cast<std::uint16_t>(c.g * 257),
             static_cast<std::uint16_t>(c.b * 257), 65535};
    // Colours whose bytes are equal, or whose low one is 0, have 8 bits.
    const auto is_deep = [](std::uint16_t v) { return v >> 8 != (v & 255) && (v & 255) != 0; };
    has_deep_palette_ =
        std::ranges::any_of(palette_, [&](Rgba16 c) { return is_deep(c.r) || is_deep(c.g) || is_deep(c.b); });
  }

  /// Reads strips or tiles, of each plane.
  template <class Image>
  Image read_pixels(Image image) {
    const bool is_tiled = library_.is_tiled(file_.get()) != 0;
    std::uint32_t part_width = layout_.width, part_height = layout_.height;
    if (is_tiled) {
      get(TIFFTAG_TILEWIDTH, part_width), get(TIFFTAG_TILELENGTH, part_height);
    } else {
      get(TIFFTAG_ROWSPERSTRIP, part_height);
      part_height = std::min(part_height, layout_.height);
    }
    const std::uint64_t size = is_tiled ? library_.tile_size(file_.get()) : library_.strip_size(file_.get()),
                        row = is_tiled ? library_.tile_row_size(file_.get()) : library_.row_size(file_.get());
    const std::uint64_t samples = layout_.is_separate() ? 1 : layout_.samples;
    if (part_width == 0 || part_height == 0 || row < (part_width * samples * layout_.bits + 7) / 8 ||
        size < row * part_height)
      fail("its parts have a wrong size");
    // A tile may be larger than the image, but not without reason.
    if (size > std::uint64_t{64} * std::max(max_pixels_, std::uint64_t{1} << 18)) fail("its parts are too large");
    std::vector<std::uint8_t> part(static_cast<std::size_t>(size));
    const std::uint16_t planes = layout_.is_separate() ? layout_.samples : std::uint16_t{1};
    for (std::uint16_t plane = 0; plane < planes; ++plane)
      for (std::uint32_t y = 0; y < layout_.height; y += std::min(part_height, layout_.height - y))
        for (std::uint32_t x = 0; x < layout_.width; x += std::min(part_width, layout_.width - x)) {
          check_deadline();
          const auto bytes = static_cast<tmsize_t>(size);
          const tmsize_t got =
              is_tiled
                  ? library_.read_tile(file_.get(), library_.tile_number(file_.get(), x, y, 0, plane), part.data(),
                                       bytes)
                  : library_.read_strip(file_.get(), library_.strip_number(file_.get(), y, plane), part.data(), bytes);
          const std::uint32_t rows = std::min(part_height, layout_.height - y);
          if (got < 0 || static_cast<std::uint64_t>(got) < rows * row) fail_by_library();
          for (std::uint32_t j = 0; j < rows; ++j)
            copy_row(View(part).subspan(static_cast<std::size_t>(j * row), static_cast<std::size_t>(row)), plane,
                     image.row(static_cast<int>(y + j)).subspan(x, std::min(part_width, layout_.width - x)));
        }
    if (layout_.alpha) finish_alpha(image);
    return image;
  }

  /// Sets the channels that a row of the file has; of separate planes, that of `plane`.
  template <class Pixel>
  void copy_row(View from, std::uint16_t plane, std::span<Pixel> to) const {
    using Value = decltype(Pixel::r);
    const Layout& l = layout_;
    for (std::size_t i = 0; i < to.size(); ++i) {
      const auto channel = [&](std::uint16_t c) {
        return sample_at(from, l.is_separate() ? i : std::uint64_t{i} * l.samples + c, l.bits);
      };
      Pixel& pixel = to[i];
      Value* const out[] = {&pixel.r, &pixel.g, &pixel.b};
      for (std::uint16_t c = 0; c < l.colors(); ++c) {
        if (l.is_separate() && c != plane) continue;
        if (l.photometric == PHOTOMETRIC_PALETTE) {
          set_color(palette_[static_cast<std::size_t>(channel(c))], pixel);
        } else if (l.is_color()) {
          *out[c] = value_of<Value>(channel(c));
        } else {
          pixel.r = pixel.g = pixel.b = value_of<Value>(channel(c));
        }
      }
      if (l.alpha && (!l.is_separate() || *l.alpha == plane)) pixel.a = alpha_of<Value>(channel(*l.alpha));
    }
  }

  static void set_color(const Rgba16& color, Rgba8& out) {
    out.r = static_cast<std::uint8_t>(color.r >> 8), out.g = static_cast<std::uint8_t>(color.g >> 8);
    out.b = static_cast<std::uint8_t>(color.b >> 8);
  }
  static void set_color(const Rgba16& color, Rgba16& out) { out.r = color.r, out.g = color.g, out.b = color.b; }
  static void set_color(const Rgba16&, Linear&) {}  // light has no palette

  template <class Value>
  Value alpha_of(std::uint64_t stored) const {
    if constexpr (std::is_same_v<Value, float>) {
      if (layout_.bits == 16) return half_value(static_cast<std::uint16_t>(stored));
      if (layout_.bits == 32) return std::bit_cast<float>(static_cast<std::uint32_t>(stored));
      return static_cast<float>(std::bit_cast<double>(stored));
    } else {
      const std::uint64_t most = (std::uint64_t{1} << layout_.bits) - 1, wide = std::numeric_limits<Value>::max();
      return static_cast<Value>(stored * wide / most);  // exact: `most` divides 255 and 65535
    }
  }
  template <class Value>
  Value value_of(std::uint64_t stored) const {
    const auto value = alpha_of<Value>(stored);
    if (layout_.photometric != PHOTOMETRIC_MINISWHITE) return value;
    if constexpr (std::is_same_v<Value, float>)
      return 1 - value;
    else
      return static_cast<Value>(std::numeric_limits<Value>::max() - value);
  }

  /// Light is premultiplied, and codes are straight.
  void finish_alpha(LinearImage& image) const {
    if (layout_.is_premultiplied) return;
    for (Linear& c : image.values()) c = {c.r * c.a, c.g * c.a, c.b * c.a, c.a};
  }
  template <class Pixel>
  void finish_alpha(Plane<Pixel>& image) const {
    if (!layout_.is_premultiplied) return;
    using Value = decltype(Pixel::r);
    constexpr std::uint64_t most = std::numeric_limits<Value>::max();
    for (Pixel& c : image.values()) {
      const auto straight = [&, a = c.a](Value v) {
        return a == 0 ? Value{0} : static_cast<Value>(std::min(most, (v * most + a / 2) / a));
      };
      c = {straight(c.r), straight(c.g), straight(c.b), c.a};
    }
  }

  const std::string& name_;
  const std::uint64_t max_pixels_;
  const TiffLibrary library_;
  Source source_;
  std::unique_ptr<TIFF, void (*)(TIFF*)> file_{nullptr, nullptr};
  Layout layout_;
  std::vector<Rgba16> palette_;
  bool has_deep_palette_ = false;
};

/// The numbers of a directory, at first of the first one.
class Directory {
 public:
  explicit Directory(View bytes) : bytes_(bytes), is_big_endian_(bytes[0] == 'M') {
    if (number(2, 2) == 43) word_ = 8, count_bytes_ = 8, entry_ = 20;
    go_to(number(word_, word_));
  }

  /// Goes to the directory behind this one; false if there is none.
  bool go_on() {
    const std::uint64_t next = number(first_ + entries_ * entry_, word_);
    return next != 0 && go_to(next);
  }

  std::uint64_t place() const { return first_; }

  /// The first number of a field; nothing if there is no such field.
  std::optional<std::uint64_t> find(std::uint64_t tag) const {
    constexpr std::uint64_t short_type = 3, long_type = 4, long8_type = 16;
    const std::optional<std::uint64_t> at = entry_of(tag);
    if (!at) return std::nullopt;
    const std::uint64_t type = number(*at + 2, 2), value_at = *at + 4 + word_;
    if (type == short_type) return number(value_at, 2);
    if (type == long_type) return number(value_at, 4);
    if (type == long8_type && word_ == 8) return number(value_at, 8);
    return std::nullopt;
  }

  /// The bytes of a field of bytes that does not fit into its entry; empty if there is none.
  View find_bytes(std::uint64_t tag) const {
    constexpr std::uint64_t byte_type = 1, undefined_type = 7;
    const std::optional<std::uint64_t> at = entry_of(tag);
    if (!at) return {};
    const std::uint64_t type = number(*at + 2, 2), size = number(*at + 4, word_),
                        begin = number(*at + 4 + word_, word_);
    if ((type != byte_type && type != undefined_type) || size <= word_ || begin > bytes_.size() ||
        bytes_.size() - begin < size)
      return {};
    return bytes_.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(size));
  }

 private:
  bool go_to(std::uint64_t at) {
    first_ = entries_ = 0;
    if (at > bytes_.size() || bytes_.size() - at < count_bytes_) return false;
    first_ = at + count_bytes_;
    entries_ = std::min(number(at, count_bytes_), (bytes_.size() - first_) / entry_);
    return true;
  }

  std::optional<std::uint64_t> entry_of(std::uint64_t tag) const {
    for (std::uint64_t i = 0; i < entries_; ++i)
      if (const std::uint64_t at = first_ + i * entry_; number(at, 2) == tag) return at;
    return std::nullopt;
  }

  std::uint64_t number(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes_.size() || bytes_.size() - at < size) return 0;
    std::uint64_t value = 0;
    for (std::uint64_t i = 0; i < size; ++i)
      value = value << 8 | bytes_[static_cast<std::size_t>(at + (is_big_endian_ ? i : size - 1 - i))];
    return value;
  }

  View bytes_;
  bool is_big_endian_;
  std::uint64_t word_ = 4, count_bytes_ = 2, entry_ = 12, first_ = 0, entries_ = 0;
};

}  // namespace

bool is_tiff(View bytes) {
  if (bytes.size() < 8) return false;
  const bool is_little = bytes[0] == 'I' && bytes[1] == 'I' && bytes[3] == 0,
             is_big = bytes[0] == 'M' && bytes[1] == 'M' && bytes[2] == 0;
  const std::uint8_t version = is_little ? bytes[2] : bytes[3];
  return (is_little || is_big) && (version == 42 || version == 43);
}

std::optional<int2> find_tiff_size(View bytes) {
  if (!is_tiff(bytes)) return std::nullopt;
  const Directory directory(bytes);
  constexpr std::uint64_t most = 0x7fffffff;
  const std::uint64_t width = directory.find(TIFFTAG_IMAGEWIDTH).value_or(0),
                      height = directory.find(TIFFTAG_IMAGELENGTH).value_or(0);
  if (width == 0 || height == 0 || width > most || height > most) return std::nullopt;
  return int2{static_cast<int>(width), static_cast<int>(height)};
}

std::size_t count_tiff_pages(View bytes) {
  if (!is_tiff(bytes)) return 0;
  constexpr std::size_t most = 1'000'000;
  std::size_t pages = 0;
  std::set<std::uint64_t> seen;  // a damaged file may point back
  Directory directory(bytes);
  do pages += (directory.find(TIFFTAG_SUBFILETYPE).value_or(0) & FILETYPE_REDUCEDIMAGE) == 0;
  while (seen.insert(directory.place()).second && seen.size() < most && directory.go_on() &&
         !seen.contains(directory.place()));
  return pages;
}

ColorTags find_tiff_colors(View bytes) {
  if (!is_tiff(bytes)) return {};
  const Directory directory(bytes);
  const std::uint64_t pixels = directory.find(TIFFTAG_PHOTOMETRIC).value_or(PHOTOMETRIC_RGB);
  return {.profile = directory.find_bytes(TIFFTAG_ICCPROFILE),
          .is_grey = pixels == PHOTOMETRIC_MINISWHITE || pixels == PHOTOMETRIC_MINISBLACK};
}

StoredImage decode_tiff(View bytes, const std::string& name, std::uint64_t max_pixels) {
  const std::optional<int2> size = find_tiff_size(bytes);
  if (!size) throw Error(ErrorKind::Input, name + ": TIFF: its first directory states no size");
  const std::uint64_t pixels = static_cast<std::uint64_t>(size->x) * static_cast<std::uint64_t>(size->y);
  if (pixels > max_pixels)
    throw Error(ErrorKind::Input,
                fmt::format("{}: TIFF: {} x {} pixels, at most {} are allowed", name, size->x, size->y, max_pixels));
  // What libtiff finds may not be more than the first directory states. The image, the samples of a strip of it as
  // doubles, and a fixed overhead.
  const std::uint64_t memory = 80 * pixels + 2 * bytes.size() + (std::uint64_t{64} << 20);
  return decode_in_child(name + ": TIFF", Library::Tiff, memory, pixels,
                         [&] { return TiffReader(bytes, name, pixels).read(); });
}

}  // namespace zoneplate
