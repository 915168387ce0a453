// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/bitmap/bmp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/bitmap/bytes.h"
#include "zoneplate/codec/bitmap/opaque.h"

namespace zoneplate {
namespace {

enum Compression : std::uint32_t { Rgb = 0, Rle8 = 1, Rle4 = 2, BitFields = 3, AlphaBitFields = 6 };

constexpr std::size_t file_header = 14, core_header = 12, info_header = 40, v3_header = 56;

struct Header {
  std::uint32_t size = 0;  ///< of the second header
  int width = 0, height = 0;
  bool is_top_down = false;
  std::uint32_t bits = 0, compression = Rgb, colors = 0, pixels_at = 0;

  bool is_core() const { return size == core_header; }
  bool has_palette() const { return bits <= 8; }
  bool is_run_length() const { return compression == Rle8 || compression == Rle4; }
  bool has_masks() const { return compression == BitFields || compression == AlphaBitFields; }
  /// Bytes between the start of two rows.
  std::uint64_t stride() const { return (static_cast<std::uint64_t>(width) * bits + 31) / 32 * 4; }
};

std::optional<Header> parse_header(std::span<const std::uint8_t> bytes) {
  if (!is_bmp(bytes) || bytes.size() < file_header + core_header) return std::nullopt;
  Header h{.size = little_endian(bytes, file_header, 4), .pixels_at = little_endian(bytes, 10, 4)};
  constexpr std::uint32_t longest_header = 124;
  if (!h.is_core() && (h.size < info_header || h.size > longest_header)) return std::nullopt;
  if (bytes.size() < file_header + h.size) return std::nullopt;
  if (h.is_core()) {
    h.width = static_cast<int>(little_endian(bytes, 18, 2)), h.height = static_cast<int>(little_endian(bytes, 20, 2));
    h.bits = little_endian(bytes, 24, 2);
  } else {
    h.width = static_cast<int>(little_endian(bytes, 18, 4)), h.height = static_cast<int>(little_endian(bytes, 22, 4));
    h.bits = little_endian(bytes, 28, 2), h.compression = little_endian(bytes, 30, 4);
    h.colors = little_endian(bytes, 46, 4);
  }
  h.is_top_down = h.height < 0;
  if (h.height == std::numeric_limits<int>::min()) return std::nullopt;
  h.height = std::abs(h.height);
  if (h.width <= 0 || h.height == 0) return std::nullopt;
  return h;
}

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> bytes, const std::string& name, const Header& header)
      : bytes_(bytes), name_(name), header_(header) {}

  Rgba8Image decode() {
    check();
    if (header_.has_palette()) read_palette();
    if (header_.has_masks()) read_masks();
    if (header_.pixels_at > bytes_.size()) fail("truncated");
    pixels_ = bytes_.subspan(header_.pixels_at);
    if (!header_.is_run_length() && pixels_.size() < min_bytes()) fail("truncated");
    Rgba8Image image(header_.width, header_.height, header_.has_palette() ? color(0) : Rgba8{0, 0, 0, 255});
    if (header_.is_run_length())
      read_runs(image);
    else
      for (int y = 0; y < header_.height; ++y) read_row(y, image);
    if (masks_[3] != 0) make_opaque_if_clear(image);
    return image;
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorKind::Input, fmt::format("{}: BMP: {}", name_, cause));
  }

  void check() const {
    const std::uint32_t bits = header_.bits, compression = header_.compression;
    if (bits != 1 && bits != 4 && bits != 8 && bits != 16 && bits != 24 && bits != 32)
      fail(fmt::format("{} bits per pixel, expected 1, 4, 8, 16, 24 or 32", bits));
    const bool fits = compression == Rgb || (compression == Rle8 && bits == 8) || (compression == Rle4 && bits == 4) ||
                      (header_.has_masks() && (bits == 16 || bits == 32));
    if (!fits) fail(fmt::format("compression {} of {} bits per pixel is not supported", compression, bits));
    if (header_.is_run_length() && header_.is_top_down) fail("is run-length encoded from the top");
  }

  /// Bytes of all rows; the last one may lack its padding.
  std::uint64_t min_bytes() const {
    return header_.stride() * static_cast<std::uint64_t>(header_.height - 1) +
           (static_cast<std::uint64_t>(header_.width) * header_.bits + 7) / 8;
  }

  void read_palette() {
    const std::size_t entry = header_.is_core() ? 3 : 4, most = std::size_t{1} << header_.bits;
    std::size_t begin = file_header + header_.size;
    if (header_.pixels_at < begin) fail("its pixels begin within its header");
    const std::size_t room = (std::min<std::size_t>(header_.pixels_at, bytes_.size()) - begin) / entry;
    const std::size_t stated = header_.colors == 0 ? most : std::min<std::size_t>(header_.colors, most);
    for (std::size_t i = 0; i < std::min(stated, room); ++i, begin += entry)
      palette_.push_back({bytes_[begin + 2], bytes_[begin + 1], bytes_[begin], 255});
    if (palette_.empty()) fail("has no palette");
  }

  /// The masks follow the header of 40 bytes, and are a part of longer ones.
  void read_masks() {
    constexpr std::size_t masks_at = file_header + info_header;
    const bool has_alpha = header_.compression == AlphaBitFields || header_.size >= v3_header;
    const std::size_t count = has_alpha ? 4 : 3;
    if (bytes_.size() < masks_at + 4 * count) fail("truncated");
    for (std::size_t i = 0; i < count; ++i) {
      masks_[i] = little_endian(bytes_, masks_at + 4 * i, 4);
      const std::uint32_t low = masks_[i] == 0 ? 0 : masks_[i] >> std::countr_zero(masks_[i]);
      if ((low & (low + 1)) != 0) fail("a bit field has gaps");
    }
  }

  Rgba8 color(std::size_t index) const {
    if (index >= palette_.size()) fail(fmt::format("names colour {} of a palette of {}", index, palette_.size()));
    return palette_[index];
  }

  Rgba8 pixel_of(std::uint32_t value) const {
    return {unorm8_under(masks_[0], value), unorm8_under(masks_[1], value), unorm8_under(masks_[2], value),
            masks_[3] == 0 ? std::uint8_t{255} : unorm8_under(masks_[3], value)};
  }

  std::span<Rgba8> row(int y, Rgba8Image& image) const {
    return image.row(header_.is_top_down ? y : header_.height - 1 - y);
  }

  void read_row(int y, Rgba8Image& image) const {
    check_deadline();
    const std::span<const std::uint8_t> from = pixels_.subspan(static_cast<std::size_t>(y) * header_.stride());
    const std::span<Rgba8> to = row(y, image);
    if (header_.has_palette()) {
      for (std::size_t x = 0; x < to.size(); ++x) {
        const std::size_t bit = x * header_.bits;
        to[x] = color(from[bit / 8] >> (8 - header_.bits - bit % 8) & ((1u << header_.bits) - 1));
      }
      return;
    }
    const std::size_t size = header_.bits / 8;
    for (std::size_t x = 0; x < to.size(); ++x)
      to[x] = size == 3 ? Rgba8{from[3 * x + 2], from[3 * x + 1], from[3 * x], 255}
                        : pixel_of(little_endian(from, size * x, size));
  }

  /// The pairs of bytes of RLE8 and RLE4: a count and its colours, or 0 and an escape: the end of the row, of the
  /// image, a step to the right and up, or that many single pixels, filled to whole words. Pixels outside are not
  /// drawn.
  void read_runs(Rgba8Image& image) const {
    const bool has_nibbles = header_.compression == Rle4;
    std::size_t at = 0;
    std::uint64_t x = 0, y = 0;
    const auto width = static_cast<std::uint64_t>(header_.width), height = static_cast<std::uint64_t>(header_.height);
    const auto take = [&] {
      if (at == pixels_.size()) fail("truncated");
      return pixels_[at++];
    };
    const auto nibble = [](std::uint8_t pair, int i) { return i % 2 == 0 ? pair >> 4 : pair & 15; };
    const auto put = [&](int index) {
      if (y < height && x < width) row(static_cast<int>(y), image)[x] = color(static_cast<std::size_t>(index));
      ++x;
    };
    // Some programs leave out the end of the image, and other bytes may follow its last pixel.
    while (y + (x >= width ? 1 : 0) < height) {
      const std::uint8_t count = take(), value = take();
      if (count > 0) {
        for (int i = 0; i < count; ++i) put(has_nibbles ? nibble(value, i) : value);
      } else if (value == 0) {
        check_deadline();
        x = 0, ++y;
      } else if (value == 1) {
        return;
      } else if (value == 2) {
        x += take(), y += take();
      } else {
        const std::size_t begin = at;
        for (int i = 0; i < value; ++i) {
          if (has_nibbles && i % 2 == 1) {
            put(nibble(pixels_[at - 1], 1));
            continue;
          }
          const std::uint8_t next = take();
          put(has_nibbles ? nibble(next, 0) : next);
        }
        if ((at - begin) % 2 == 1) take();
      }
    }
  }

  std::span<const std::uint8_t> bytes_, pixels_;
  const std::string& name_;
  Header header_;
  std::vector<Rgba8> palette_;
  /// Of red, green, blue and alpha. Without bit fields 16 bits hold five each, and the last byte of 32 bits is
  /// reserved.
  std::array<std::uint32_t, 4> masks_ = header_.bits == 16
                                            ? std::array<std::uint32_t, 4>{0x7c00, 0x03e0, 0x001f, 0}
                                            : std::array<std::uint32_t, 4>{0xff0000, 0x00ff00, 0x0000ff, 0};
};

}  // namespace

bool is_bmp(std::span<const std::uint8_t> bytes) { return bytes.size() >= 2 && bytes[0] == 'B' && bytes[1] == 'M'; }

std::optional<int2> find_bmp_size(std::span<const std::uint8_t> bytes) {
  const std::optional<Header> header = parse_header(bytes);
  return header ? std::optional(int2{header->width, header->height}) : std::nullopt;
}

Rgba8Image decode_bmp(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  if (!is_bmp(bytes)) throw Error(ErrorKind::Input, name + ": not a BMP file");
  const std::optional<Header> header = parse_header(bytes);
  if (!header) throw Error(ErrorKind::Input, name + ": BMP: its header is truncated or invalid");
  if (static_cast<std::uint64_t>(header->width) * static_cast<std::uint64_t>(header->height) > max_pixels)
    throw Error(ErrorKind::Input, fmt::format("{}: BMP: {} x {} pixels, at most {} are allowed", name, header->width,
                                              header->height, max_pixels));
  return Decoder(bytes, name, *header).decode();
}

}  // namespace zoneplate
