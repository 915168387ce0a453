#include "zoneplate/image/pfm.h"

#include <bit>
#include <cstring>
#include <string>

namespace zoneplate {

std::vector<std::uint8_t> encode_pfm(const LinearImage& image) {
  static_assert(std::endian::native == std::endian::little, "-1.0 says so");
  const std::string head = "PF\n" + std::to_string(image.width()) + " " + std::to_string(image.height()) + "\n-1.0\n";
  std::vector<std::uint8_t> out(head.begin(), head.end());
  out.reserve(head.size() + image.values().size() * 12);
  for (int y = image.height(); y-- > 0;)
    for (const Linear& c : image.row(y)) {
      const float rgb[3] = {c.r, c.g, c.b};
      std::uint8_t bytes[sizeof rgb];
      std::memcpy(bytes, rgb, sizeof rgb);
      out.insert(out.end(), bytes, bytes + sizeof rgb);
    }
  return out;
}

}  // namespace zoneplate
