// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/hdr.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>
#include <vector>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

constexpr int max_side = 1 << 24;

/// The order of the pixels in the file: scanlines run along one axis and follow each other along the other axis.
struct Scan {
  int width = 0, height = 0;
  bool is_by_columns = false;  ///< a scanline is a column
  bool is_x_down = false;      ///< from right to left
  bool is_y_up = false;        ///< from the bottom up

  int lines() const { return is_by_columns ? width : height; }
  int length() const { return is_by_columns ? height : width; }
};

/// Takes an unsigned number from the front of `text`; 0 if there is none.
int take_number(std::string_view& text) {
  long value = 0;
  while (!text.empty() && text.front() >= '0' && text.front() <= '9') {
    value = std::min<long>(value * 10 + (text.front() - '0'), max_side);
    text.remove_prefix(1);
  }
  return static_cast<int>(value);
}

/// Parses the resolution line, which ends the header: "-Y 512 +X 1024", the outer axis first.
std::optional<Scan> parse_scan(std::string_view line) {
  Scan scan;
  bool has[2] = {};  // x, y
  for (int i = 0; i < 2; ++i) {
    if (line.size() < 4 || (line[0] != '-' && line[0] != '+') || line[2] != ' ') return std::nullopt;
    const char axis = line[1];
    if (axis != 'X' && axis != 'Y') return std::nullopt;
    const bool is_minus = line[0] == '-';
    line.remove_prefix(3);
    const int size = take_number(line);
    if (size < 1 || has[axis == 'Y']) return std::nullopt;
    has[axis == 'Y'] = true;
    if (i == 0) scan.is_by_columns = axis == 'X';
    if (axis == 'X')
      scan.width = size, scan.is_x_down = is_minus;
    else
      scan.height = size, scan.is_y_up = !is_minus;
    while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
  }
  if (!line.empty() && line != "\r") return std::nullopt;
  return scan;
}

struct Header {
  Scan scan;
  bool is_rgbe = true;
  std::size_t end = 0;  ///< offset of the pixels
};

std::optional<Header> parse_header(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t max_header = std::size_t{1} << 16;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), max_header));
  Header header;
  bool is_over = false;  // the empty line after the header was found
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (is_over) {
      const std::optional<Scan> scan = parse_scan(line);
      if (!scan) return std::nullopt;
      header.scan = *scan, header.end = at;
      return header;
    }
    if (line.starts_with("FORMAT=")) header.is_rgbe = line.starts_with("FORMAT=32-bit_rle_rgbe");
    is_over = line.empty() || line == "\r";
  }
}

using Rgbe = std::array<std::uint8_t, 4>;

/// Converts mantissas and exponent to linear colour.
Linear light_of(Rgbe p) {
  if (p[3] == 0) return {0, 0, 0, 1};
  const auto unit = std::bit_cast<double>((std::uint64_t{p[3]} + 1023 - 136) << 52);  // 2^(exponent - 136)
  return {static_cast<float>(p[0] * unit), static_cast<float>(p[1] * unit), static_cast<float>(p[2] * unit), 1};
}

/// Decompresses scanlines one after the other; `read` returns false on corrupt data.
class LineReader {
 public:
  explicit LineReader(std::span<const std::uint8_t> packed) : packed_(packed) {}

  bool read(std::span<Rgbe> line) {
    const std::size_t n = line.size();
    const bool may_be_new = n >= 8 && n < 32768 && left() >= 4;
    if (may_be_new && packed_[at_] == 2 && packed_[at_ + 1] == 2 && packed_[at_ + 2] < 128) {
      const std::size_t stated = packed_[at_ + 2] * std::size_t{256} + packed_[at_ + 3];
      at_ += 4;
      return stated == n && read_channels(line);
    }
    return read_pixels(line);
  }

 private:
  std::size_t left() const { return packed_.size() - at_; }

  /// Reads a scanline of the new run-length encoding, channel by channel: a count of 128 + n repeats the next byte n
  /// times; another count is followed by that many literal bytes.
  bool read_channels(std::span<Rgbe> line) {
    for (std::size_t channel = 0; channel < 4; ++channel)
      for (std::size_t x = 0; x < line.size();) {
        if (left() < 2) return false;
        const std::size_t code = packed_[at_++];
        const bool is_run = code > 128;
        const std::size_t count = is_run ? code - 128 : code;
        if (count == 0 || count > line.size() - x || (!is_run && count > left())) return false;
        for (std::size_t i = 0; i < count; ++i) line[x++][channel] = packed_[is_run ? at_ : at_ + i];
        at_ += is_run ? 1 : count;
      }
    return true;
  }

  /// Reads a scanline of the old run-length encoding, pixel by pixel: 1 1 1 n repeats the last pixel n times; directly
  /// after another repetition it repeats it n << 8 times, then n << 16, and so on.
  bool read_pixels(std::span<Rgbe> line) {
    int shift = 0;
    for (std::size_t x = 0; x < line.size();) {
      if (left() < 4) return false;
      const Rgbe pixel{packed_[at_], packed_[at_ + 1], packed_[at_ + 2], packed_[at_ + 3]};
      at_ += 4;
      if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
        line[x++] = last_ = pixel;
        shift = 0;
        continue;
      }
      if (shift > 16) return false;
      const std::size_t count = std::size_t{pixel[3]} << shift;
      if (count > line.size() - x) return false;
      std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(x), count, last_);
      x += count;
      shift += 8;
    }
    return true;
  }

  std::span<const std::uint8_t> packed_;
  std::size_t at_ = 0;
  Rgbe last_{};
};

/// Calls `put(x, y, pixel)` for each pixel, in the order of the file.
template <class Put>
void for_pixels(const Scan& scan, std::span<const std::uint8_t> packed, const std::string& name, const Put& put) {
  LineReader reader(packed);
  std::vector<Rgbe> line(static_cast<std::size_t>(scan.length()));
  for (int j = 0; j < scan.lines(); ++j) {
    constexpr int lines_per_check = 16;
    if (j % lines_per_check == 0) check_deadline();
    if (!reader.read(line))
      throw Error(ErrorKind::Input, name + ": HDR: scanline " + std::to_string(j) + " is corrupt or cut off");
    for (int i = 0; i < scan.length(); ++i) {
      const int x = scan.is_by_columns ? j : i, y = scan.is_by_columns ? i : j;
      put(scan.is_x_down ? scan.width - 1 - x : x, scan.is_y_up ? scan.height - 1 - y : y,
          line[static_cast<std::size_t>(i)]);
    }
  }
}

/// Decodes an image whose pixels are `to_pixel(light)`.
template <class Image, class ToPixel>
Image decode(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
             const ToPixel& to_pixel) {
  const auto fail = [&](const std::string& cause) -> Error { return {ErrorKind::Input, name + ": HDR: " + cause}; };
  const auto header = is_hdr(bytes) ? parse_header(bytes) : std::nullopt;
  if (!header) throw fail("the header is wrong");
  if (!header->is_rgbe) throw fail("its pixels are not RGBE");
  const Scan& scan = header->scan;
  const std::uint64_t pixels = static_cast<std::uint64_t>(scan.width) * static_cast<std::uint64_t>(scan.height);
  if (pixels > max_pixels)
    throw fail(std::to_string(scan.width) + " x " + std::to_string(scan.height) + " pixels, at most " +
               std::to_string(max_pixels) + " are allowed");

  // The size in the header is verified before memory is allocated: a scanline has at least four bytes, and if the file
  // is smaller than run-length coding of images usually achieves, a first pass over it is cheap.
  constexpr std::uint64_t default_ratio = 64;
  const std::span<const std::uint8_t> packed = bytes.subspan(header->end);
  if (packed.size() < static_cast<std::uint64_t>(scan.lines()) * 4) throw fail("the file ends early");
  if (pixels / default_ratio > packed.size()) for_pixels(scan, packed, name, [](int, int, Rgbe) {});

  Image image(scan.width, scan.height);
  for_pixels(scan, packed, name, [&](int x, int y, Rgbe pixel) { image(x, y) = to_pixel(light_of(pixel)); });
  return image;
}

}  // namespace

bool is_hdr(std::span<const std::uint8_t> bytes) { return bytes.size() > 2 && bytes[0] == '#' && bytes[1] == '?'; }

std::optional<int2> find_hdr_size(std::span<const std::uint8_t> bytes) {
  const auto header = is_hdr(bytes) ? parse_header(bytes) : std::nullopt;
  if (!header) return std::nullopt;
  return int2{header->scan.width, header->scan.height};
}

LinearImage decode_hdr(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  return decode<LinearImage>(bytes, name, max_pixels, [](Linear light) { return light; });
}

Plane<float4> decode_hdr_rgba(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  return decode<Plane<float4>>(bytes, name, max_pixels, [](Linear light) {
    return float4{light.r, light.g, light.b, light.a};
  });
}

}  // namespace zoneplate
