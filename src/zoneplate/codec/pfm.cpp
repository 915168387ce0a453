// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/pfm.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

static_assert(std::endian::native == std::endian::little, "-1.0 says so");

template <class T>
std::vector<std::uint8_t> encode(const Plane<T>& image, const char* kind, std::size_t bytes_per_pixel) {
  const std::string head =
      kind + std::string("\n") + std::to_string(image.width()) + " " + std::to_string(image.height()) + "\n-1.0\n";
  std::vector<std::uint8_t> out(head.begin(), head.end());
  std::size_t at = out.size();
  out.resize(at + image.values().size() * bytes_per_pixel);
  for (int y = image.height(); y-- > 0;)
    for (const T& pixel : image.row(y)) {
      std::memcpy(&out[at], &pixel, bytes_per_pixel);
      at += bytes_per_pixel;
    }
  return out;
}

struct Header {
  bool is_color = false, is_little_endian = false;
  int width = 0, height = 0;
  std::size_t end = 0;  ///< offset of the pixels

  std::uint64_t pixels() const { return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height); }
};

bool is_space(std::uint8_t c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Parses the header: type, width, height and scale, separated by white space and followed by one white-space
/// character.
std::optional<Header> parse_header(std::span<const std::uint8_t> bytes) {
  if (!is_pfm(bytes)) return std::nullopt;
  constexpr std::size_t longest_word = 64;
  std::size_t at = 2;
  const auto take_number = [&]<class T>(T& out) {
    while (at < bytes.size() && is_space(bytes[at])) ++at;
    const char* const first = reinterpret_cast<const char*>(bytes.data()) + at;
    const char* const last = first + std::min(bytes.size() - at, longest_word);
    const auto [end, error] = std::from_chars(first, last, out);
    at += static_cast<std::size_t>(end - first);
    return error == std::errc() && at < bytes.size() && is_space(bytes[at]);
  };
  Header header{.is_color = bytes[1] == 'F'};
  double scale = 0;
  if (!take_number(header.width) || !take_number(header.height) || !take_number(scale)) return std::nullopt;
  if (header.width < 1 || header.height < 1 || scale == 0 || !std::isfinite(scale)) return std::nullopt;
  header.is_little_endian = scale < 0;
  header.end = at + 1;
  return header;
}

float float_at(const std::uint8_t* bytes, bool is_little_endian) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits = bits << 8 | bytes[is_little_endian ? 3 - i : i];
  return std::bit_cast<float>(bits);
}

}  // namespace

std::vector<std::uint8_t> encode_pfm(const LinearImage& image) { return encode(image, "PF", 3 * sizeof(float)); }

std::vector<std::uint8_t> encode_pfm(const Plane<float>& image) { return encode(image, "Pf", sizeof(float)); }

bool is_pfm(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') && is_space(bytes[2]);
}

std::optional<int2> find_pfm_size(std::span<const std::uint8_t> bytes) {
  const std::optional<Header> header = parse_header(bytes);
  if (!header) return std::nullopt;
  return int2{header->width, header->height};
}

LinearImage decode_pfm(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  const auto fail = [&](const std::string& cause) -> Error { return {ErrorKind::Input, name + ": PFM: " + cause}; };
  const std::optional<Header> header = parse_header(bytes);
  if (!header) throw fail("the header is wrong");
  if (header->pixels() > max_pixels)
    throw fail(std::to_string(header->width) + " x " + std::to_string(header->height) + " pixels, at most " +
               std::to_string(max_pixels) + " are allowed");
  const std::size_t channels = header->is_color ? 3 : 1, pixel_bytes = channels * sizeof(float);
  const std::uint64_t found = bytes.size() - header->end, stated = header->pixels() * pixel_bytes;
  if (found != stated)
    throw fail(std::to_string(found) + " bytes of pixels, the header states " + std::to_string(stated));

  LinearImage image(header->width, header->height);
  const std::uint8_t* at = bytes.data() + header->end;
  for (int y = image.height(); y-- > 0;) {
    check_deadline();
    for (Linear& pixel : image.row(y)) {
      const auto channel = [&](std::size_t i) { return float_at(at + i * sizeof(float), header->is_little_endian); };
      pixel = header->is_color ? Linear{channel(0), channel(1), channel(2), 1}
                               : Linear{channel(0), channel(0), channel(0), 1};
      at += pixel_bytes;
    }
  }
  return image;
}

}  // namespace zoneplate
