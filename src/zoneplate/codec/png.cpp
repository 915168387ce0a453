// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/png.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/png/png_color.h"
#include "zoneplate/codec/png_parts.h"

namespace zoneplate {
namespace {

static_assert(sizeof(Rgba8) == 4 && sizeof(Rgba16) == 8, "rows are handed to libpng as they lie");

/// The error message of libpng. It is kept until the stack frames of libpng are left, and then thrown as an exception.
struct Report {
  std::array<char, 256> message{};
};

/// libpng's error handler. An exception must not unwind libpng's frames, so that it jumps back to `guarded`.
[[noreturn]] void jump_back(png_structp png, png_const_charp message) {
  auto* report = static_cast<Report*>(png_get_error_ptr(png));
  std::strncpy(report->message.data(), message, report->message.size() - 1);
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

/// Runs `body`, which must not need destructors; false if libpng reported an error.
template <class Body>
bool guarded(png_structp png, Body body) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  body();
  return true;
}

/// The compressed bytes that are not yet read.
struct Input {
  std::span<const std::uint8_t> bytes;
};

void read_input(png_structp png, png_bytep out, std::size_t count) {
  auto* input = static_cast<Input*>(png_get_io_ptr(png));
  if (count > input->bytes.size()) png_error(png, "the file is truncated");
  std::memcpy(out, input->bytes.data(), count);
  input->bytes = input->bytes.subspan(count);
}

class Reader {
 public:
  Reader(std::span<const std::uint8_t> bytes, const std::string& name)
      : input_{bytes}, size_(bytes.size()), name_(name) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &report_, jump_back, ignore_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw std::bad_alloc();
    }
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// The image at the bit depth of the file, 8 or 16.
  PngImage decode(std::uint64_t max_pixels) {
    check(guarded(png_, [this] { read_header(); }));
    check_size(max_pixels);
    const int width = static_cast<int>(png_get_image_width(png_, info_));
    const int height = static_cast<int>(png_get_image_height(png_, info_));
    PngImage image;
    if (png_get_bit_depth(png_, info_) == 16) {
      image.pixels16 = Rgba16Image(width, height);
      read_rows(reinterpret_cast<png_bytep>(image.pixels16.values().data()), image.pixels16.row(0).size_bytes(),
                height);
    } else {
      image.pixels = Rgba8Image(width, height);
      read_rows(reinterpret_cast<png_bytep>(image.pixels.values().data()), image.pixels.row(0).size_bytes(), height);
    }
    return image;
  }

 private:
  void check(bool is_well) const {
    if (!is_well) throw Error(ErrorKind::Input, name_ + ": PNG: " + report_.message.data());
  }

  void read_header() {
    // Only chunks that define the image are read: no text, profiles or time. Every defect is an error.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_benign_errors(png_, 0);
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_chunk_malloc_max(png_, 8000000);
    png_set_chunk_cache_max(png_, 1000);
    png_set_read_fn(png_, &input_, read_input);
    png_read_info(png_, info_);
  }

  void check_size(std::uint64_t max_pixels) const {
    const std::uint64_t width = png_get_image_width(png_, info_), height = png_get_image_height(png_, info_);
    if (width * height > max_pixels) {
      throw Error(ErrorKind::Input, name_ + ": PNG: " + std::to_string(width) + " x " + std::to_string(height) +
                                        " pixels, at most " + std::to_string(max_pixels) + " are allowed");
    }
    // Deflate expands a byte to at most 1032 bytes: a file that claims more is truncated, and no memory is allocated
    // for it.
    if (png_get_rowbytes(png_, info_) * height / 1032 > size_) {
      throw Error(ErrorKind::Input, name_ + ": PNG: the file is truncated");
    }
  }

  void read_rows(png_bytep pixels, std::size_t stride, int height) {
    check(guarded(png_, [this, pixels, stride, height] {
      png_set_expand(png_);
      png_set_gray_to_rgb(png_);
      png_set_add_alpha(png_, 0xffff, PNG_FILLER_AFTER);
      if (std::endian::native == std::endian::little) png_set_swap(png_);
      const int passes = png_set_interlace_handling(png_);
      png_read_update_info(png_, info_);
      for (int pass = 0; pass < passes; ++pass) {
        for (int y = 0; y < height; ++y) {
          constexpr int rows_per_check = 16;
          if (y % rows_per_check == 0) check_deadline();  // here, because an exception must not unwind libpng's frames
          png_read_row(png_, pixels + static_cast<std::size_t>(y) * stride, nullptr);
        }
      }
      png_read_end(png_, nullptr);
    }));
  }

  Report report_;
  Input input_;
  std::size_t size_;
  const std::string& name_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

/// round(code / 257).
std::uint8_t narrowed(std::uint16_t code) { return static_cast<std::uint8_t>((code * 255u + 32895u) >> 16); }

}  // namespace

bool is_png(std::span<const std::uint8_t> bytes) { return bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0; }

bool has_16_bits(std::span<const std::uint8_t> png) { return png.size() > 24 && png[24] == 16; }

PngImage decode_png_as_stored(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  if (!is_png(bytes)) throw Error(ErrorKind::Input, name + ": not a PNG file");
  return Reader(bytes, name).decode(max_pixels);
}

PngImage decode_png(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  PngImage image = decode_png_as_stored(bytes, name, max_pixels);
  if (image.pixels16.empty()) return image;
  image.pixels = Rgba8Image(image.pixels16.width(), image.pixels16.height());
  std::transform(image.pixels16.values().begin(), image.pixels16.values().end(), image.pixels.values().begin(),
                 [](Rgba16 c) {
                   return Rgba8{narrowed(c.r), narrowed(c.g), narrowed(c.b), narrowed(c.a)};
                 });
  return image;
}

namespace {

/// The image to be written, as libpng describes it.
struct Rows {
  const void* pixels;
  int width, height;
  std::size_t stride;
  int color_type, bit_depth;
  bool drops_alpha;
  int filters = PNG_FILTER_UP;
  std::span<const png_color> palette = {};
};

struct Output {
  std::vector<std::uint8_t> bytes;
  bool is_full = false;
};

void write_output(png_structp png, png_bytep data, std::size_t count) {
  auto* output = static_cast<Output*>(png_get_io_ptr(png));
  try {
    output->bytes.insert(output->bytes.end(), data, data + count);
  } catch (const std::bad_alloc&) {
    output->is_full = true;
  }
  if (output->is_full) png_error(png, "out of memory");
}

void flush_output(png_structp) {}

class Writer {
 public:
  Writer() {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &report_, jump_back, ignore_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) {
      png_destroy_write_struct(&png_, &info_);
      throw std::bad_alloc();
    }
  }
  ~Writer() { png_destroy_write_struct(&png_, &info_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  std::vector<std::uint8_t> encode(const Rows& rows, const PngOptions& options) {
    std::vector<png_text> text = describe(options);
    const bool is_well = guarded(png_, [this, &rows, &options, &text] {
      png_set_write_fn(png_, &output_, write_output, flush_output);
      write_header(rows, options, text);
      write_rows(rows);
    });
    if (!is_well)
      throw Error(ErrorKind::Failed, std::string("an image cannot be encoded as PNG: ") + report_.message.data());
    return std::move(output_.bytes);
  }

 private:
  /// The texts of the file: tEXt chunks for ASCII, iTXt chunks for others, because tEXt is Latin-1.
  static std::vector<png_text> describe(const PngOptions& options) {
    std::vector<png_text> all;
    for (const auto& [key, value] : options.text) {
      const bool is_ascii =
          std::all_of(value.begin(), value.end(), [](char c) { return static_cast<signed char>(c) >= 0; });
      png_text text{};
      text.compression = is_ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
      text.key = const_cast<char*>(key.c_str());
      text.text = const_cast<char*>(value.c_str());
      text.text_length = is_ascii ? value.size() : 0;
      text.itxt_length = is_ascii ? 0 : value.size();
      all.push_back(text);
    }
    return all;
  }

  void write_header(const Rows& rows, const PngOptions& options, const std::vector<png_text>& text) {
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(rows.width), static_cast<png_uint_32>(rows.height),
                 rows.bit_depth, rows.color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (!rows.palette.empty()) png_set_PLTE(png_, info_, rows.palette.data(), static_cast<int>(rows.palette.size()));
    if (options.is_srgb) png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!text.empty()) png_set_text(png_, info_, text.data(), static_cast<int>(text.size()));

    // The rows of a rendered image differ little from the row above, so that filtering leaves runs of zeros.
    png_set_compression_level(png_, options.is_small ? Z_BEST_COMPRESSION : Z_BEST_SPEED);
    png_set_compression_strategy(png_, options.is_small ? Z_DEFAULT_STRATEGY : Z_RLE);
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, rows.filters);
    png_set_compression_buffer_size(png_, std::size_t{1} << 18);
    png_write_info(png_, info_);
  }

  void write_rows(const Rows& rows) {
    if (rows.drops_alpha) png_set_filler(png_, 0, PNG_FILLER_AFTER);
    if (rows.bit_depth == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
    const auto* pixels = static_cast<png_const_bytep>(rows.pixels);
    for (int y = 0; y < rows.height; ++y) png_write_row(png_, pixels + static_cast<std::size_t>(y) * rows.stride);
    png_write_end(png_, info_);
  }

  Report report_;
  Output output_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

/// Encodes an image. If it has to be small, the smaller of two encodings is returned: filters shorten shaded images but
/// lengthen drawings.
std::vector<std::uint8_t> encode(Rows rows, const PngOptions& options) {
  if (!options.is_small) return Writer().encode(rows, options);
  rows.filters = PNG_FILTER_NONE;
  std::vector<std::uint8_t> plain = Writer().encode(rows, options);
  rows.filters = PNG_ALL_FILTERS;
  std::vector<std::uint8_t> filtered = Writer().encode(rows, options);
  return plain.size() <= filtered.size() ? plain : filtered;
}

template <class T>
std::vector<std::uint8_t> encode(const Plane<T>& image, const PngOptions& options, int bit_depth, bool is_grey) {
  const bool drops_alpha = !is_grey && !options.has_alpha;
  const int color_type = is_grey ? PNG_COLOR_TYPE_GRAY : drops_alpha ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA;
  const std::size_t stride = static_cast<std::size_t>(image.width()) * sizeof(T);
  return encode({image.values().data(), image.width(), image.height(), stride, color_type, bit_depth, drops_alpha},
                options);
}

std::uint32_t word_of(Rgba8 c) { return std::uint32_t{c.r} << 16 | std::uint32_t{c.g} << 8 | c.b; }

/// The colours of an image without alpha, sorted; empty if there are more than 256.
std::vector<std::uint32_t> colors_of(const Rgba8Image& image) {
  std::vector<std::uint32_t> colors;
  std::uint32_t last = ~std::uint32_t{0};
  for (const Rgba8 c : image.values()) {
    if (word_of(c) == std::exchange(last, word_of(c))) continue;
    const auto place = std::lower_bound(colors.begin(), colors.end(), last);
    if (place != colors.end() && *place == last) continue;
    if (colors.size() == 256) return {};
    colors.insert(place, last);
  }
  return colors;
}

std::vector<std::uint8_t> encode_indexed(const Rgba8Image& image, const std::vector<std::uint32_t>& colors,
                                         const PngOptions& options) {
  Plane<std::uint8_t> numbers(image.width(), image.height());
  std::transform(image.values().begin(), image.values().end(), numbers.values().begin(), [&](Rgba8 c) {
    return static_cast<std::uint8_t>(std::lower_bound(colors.begin(), colors.end(), word_of(c)) - colors.begin());
  });
  std::vector<png_color> palette;
  for (const std::uint32_t c : colors)
    palette.push_back(
        {static_cast<png_byte>(c >> 16), static_cast<png_byte>(c >> 8 & 255), static_cast<png_byte>(c & 255)});
  return encode({.pixels = numbers.values().data(),
                 .width = image.width(),
                 .height = image.height(),
                 .stride = static_cast<std::size_t>(image.width()),
                 .color_type = PNG_COLOR_TYPE_PALETTE,
                 .bit_depth = 8,
                 .drops_alpha = false,
                 .palette = palette},
                options);
}

}  // namespace

namespace {

/// The file that `encode` makes without an sRGB chunk, with the chunks of the profile after IHDR.
template <class Encode>
std::vector<std::uint8_t> with_profile(const PngOptions& options, const Encode& encode) {
  PngOptions plain = options;
  plain.profile = {}, plain.is_srgb = false;
  std::vector<std::uint8_t> out = encode(plain);
  const std::vector<std::uint8_t> chunks = png_color_chunks(options.profile);
  constexpr std::ptrdiff_t after_header = 33;  // the signature, and IHDR
  out.insert(out.begin() + after_header, chunks.begin(), chunks.end());
  return out;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Rgba8Image& image, const PngOptions& options) {
  if (!options.profile.empty())
    return with_profile(options, [&](const PngOptions& plain) { return encode_png(image, plain); });
  const bool is_plain = !options.is_small && !options.may_be_indexed && options.text.empty();
  if (is_plain && image.width() > 0 && image.height() > 0) return encode_png_parts(image, options);
  if (options.may_be_indexed && !options.has_alpha)
    if (const std::vector<std::uint32_t> colors = colors_of(image); !colors.empty())
      return encode_indexed(image, colors, options);
  return encode(image, options, 8, false);
}

std::vector<std::uint8_t> encode_png(const Rgba16Image& image, const PngOptions& options) {
  if (!options.profile.empty())
    return with_profile(options, [&](const PngOptions& plain) { return encode_png(image, plain); });
  return encode(image, options, 16, false);
}

std::vector<std::uint8_t> encode_png(const Plane<std::uint16_t>& image, const PngOptions& options) {
  return encode(image, options, 16, true);
}

}  // namespace zoneplate
