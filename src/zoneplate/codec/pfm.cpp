#include "zoneplate/codec/pfm.h"

#include <bit>
#include <cstring>
#include <string>

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

}  // namespace

std::vector<std::uint8_t> encode_pfm(const LinearImage& image) { return encode(image, "PF", 3 * sizeof(float)); }

std::vector<std::uint8_t> encode_pfm(const Plane<float>& image) { return encode(image, "Pf", sizeof(float)); }

}  // namespace zoneplate
