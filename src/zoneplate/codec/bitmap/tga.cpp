// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/bitmap/tga.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/bitmap/bytes.h"
#include "zoneplate/codec/bitmap/opaque.h"

namespace zoneplate {
namespace {

constexpr std::size_t header_size = 18;
constexpr std::uint32_t color_mapped = 1, true_color = 2, grey = 3, run_length = 8;

bool is_color_depth(std::uint32_t bits) { return bits == 15 || bits == 16 || bits == 24 || bits == 32; }

struct Header {
  std::uint32_t kind = 0;  ///< color_mapped, true_color or grey
  bool is_run_length = false;
  std::uint32_t map_first = 0, map_count = 0, map_bits = 0;
  int width = 0, height = 0;
  std::uint32_t bits = 0, alpha_bits = 0;
  bool is_from_right = false, is_from_top = false;
  std::size_t map_at = 0;

  std::size_t pixel_bytes() const { return (bits + 7) / 8; }
  std::size_t map_entry_bytes() const { return (map_bits + 7) / 8; }
  std::uint64_t pixels_at() const { return map_at + std::uint64_t{map_count} * map_entry_bytes(); }
  std::uint64_t pixels() const { return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height); }
};

/// The header if it is valid: other bytes are recognised as no TGA by it alone.
std::optional<Header> parse_header(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < header_size) return std::nullopt;
  const std::uint32_t map_kind = bytes[1], descriptor = bytes[17];
  const Header h{.kind = bytes[2] & ~run_length,
                 .is_run_length = (bytes[2] & run_length) != 0,
                 .map_first = little_endian(bytes, 3, 2),
                 .map_count = little_endian(bytes, 5, 2),
                 .map_bits = bytes[7],
                 .width = static_cast<int>(little_endian(bytes, 12, 2)),
                 .height = static_cast<int>(little_endian(bytes, 14, 2)),
                 .bits = bytes[16],
                 .alpha_bits = descriptor & 15,
                 .is_from_right = (descriptor & 16) != 0,
                 .is_from_top = (descriptor & 32) != 0,
                 .map_at = header_size + bytes[0]};
  const bool has_map = map_kind == 1 && h.map_count > 0 && is_color_depth(h.map_bits);
  const bool has_no_map = map_kind == 0 && h.map_count == 0;
  const bool has_depth = h.kind == color_mapped ? has_map && (h.bits == 8 || h.bits == 16)
                         : h.kind == true_color ? is_color_depth(h.bits)
                         : h.kind == grey       ? h.bits == 8 || h.bits == 16
                                                : false;
  const bool is_valid = (has_map || has_no_map) && has_depth && h.alpha_bits <= 8 && (descriptor & 0xc0) == 0 &&
                        h.width > 0 && h.height > 0 && h.pixels_at() <= bytes.size();
  return is_valid ? std::optional(h) : std::nullopt;
}

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> bytes, const std::string& name, const Header& header)
      : pixels_(bytes.subspan(static_cast<std::size_t>(header.pixels_at()))), name_(name), header_(header) {
    if (header.kind != color_mapped) return;
    for (std::size_t i = 0; i < header.map_count; ++i)
      map_.push_back(color_of(bytes.subspan(header.map_at + i * header.map_entry_bytes()), header.map_bits));
  }

  Rgba8Image decode() {
    // A packet of run lengths has at most 128 pixels and at least one byte besides the pixel's.
    const std::uint64_t least = header_.is_run_length ? (header_.pixels() + 127) / 128 * (1 + header_.pixel_bytes())
                                                      : header_.pixels() * header_.pixel_bytes();
    if (pixels_.size() < least) fail("truncated");
    Rgba8Image image(header_.width, header_.height);
    for (int y = 0; y < header_.height; ++y) {
      check_deadline();
      for (int x = 0; x < header_.width; ++x)
        image(header_.is_from_right ? header_.width - 1 - x : x, header_.is_from_top ? y : header_.height - 1 - y) =
            next();
    }
    make_opaque_if_clear(image);
    return image;
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorKind::Input, fmt::format("{}: TGA: {}", name_, cause));
  }

  Rgba8 color_of(std::span<const std::uint8_t> at, std::uint32_t bits) const {
    if (bits >= 24) return {at[2], at[1], at[0], bits == 32 ? at[3] : std::uint8_t{255}};
    const std::uint32_t value = little_endian(at, 0, 2);
    const bool has_alpha = bits == 16 && header_.alpha_bits == 1;
    return {unorm8_under(0x7c00, value), unorm8_under(0x03e0, value), unorm8_under(0x001f, value),
            has_alpha ? unorm8_under(0x8000, value) : std::uint8_t{255}};
  }

  std::span<const std::uint8_t> take(std::size_t count) {
    if (pixels_.size() < count) fail("truncated");
    const std::span<const std::uint8_t> taken = pixels_.first(count);
    pixels_ = pixels_.subspan(count);
    return taken;
  }

  Rgba8 read_pixel() {
    const std::span<const std::uint8_t> at = take(header_.pixel_bytes());
    if (header_.kind == grey) return {at[0], at[0], at[0], header_.bits == 16 ? at[1] : std::uint8_t{255}};
    if (header_.kind == true_color) return color_of(at, header_.bits);
    const std::uint32_t index = little_endian(at, 0, header_.pixel_bytes());
    if (index < header_.map_first || index - header_.map_first >= map_.size())
      fail(fmt::format("names colour {} of a map from {} to {}", index, header_.map_first,
                       header_.map_first + map_.size() - 1));
    return map_[index - header_.map_first];
  }

  /// The next pixel in the order of the file. Packets may continue in the next row.
  Rgba8 next() {
    if (!header_.is_run_length) return read_pixel();
    if (left_ == 0) {
      const std::uint8_t head = take(1)[0];
      left_ = 1 + (head & 127);
      is_repeated_ = head >= 128;
      if (is_repeated_) repeated_ = read_pixel();
    }
    --left_;
    return is_repeated_ ? repeated_ : read_pixel();
  }

  std::span<const std::uint8_t> pixels_;
  const std::string& name_;
  Header header_;
  std::vector<Rgba8> map_;
  int left_ = 0;  ///< pixels of the packet
  bool is_repeated_ = false;
  Rgba8 repeated_{};
};

}  // namespace

bool is_tga(std::span<const std::uint8_t> bytes) { return parse_header(bytes).has_value(); }

std::optional<int2> find_tga_size(std::span<const std::uint8_t> bytes) {
  const std::optional<Header> header = parse_header(bytes);
  return header ? std::optional(int2{header->width, header->height}) : std::nullopt;
}

Rgba8Image decode_tga(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  const std::optional<Header> header = parse_header(bytes);
  if (!header) throw Error(ErrorKind::Input, name + ": not a TGA file");
  if (header->pixels() > max_pixels)
    throw Error(ErrorKind::Input, fmt::format("{}: TGA: {} x {} pixels, at most {} are allowed", name, header->width,
                                              header->height, max_pixels));
  return Decoder(bytes, name, *header).decode();
}

}  // namespace zoneplate
