// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// FNV-1a over the bits of a linear image.
inline std::uint64_t hash_of(const LinearImage& image) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const Linear& c : image.values())
    for (const float v : {c.r, c.g, c.b, c.a}) {
      std::uint32_t word = 0;
      std::memcpy(&word, &v, sizeof word);
      for (int byte = 0; byte < 4; ++byte) h = (h ^ (word >> (8 * byte) & 0xff)) * 0x100000001b3u;
    }
  return h;
}

/// FNV-1a over the codes of an image as it is shown.
inline std::uint64_t hash_of(const Rgba8Image& image) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const Rgba8& c : image.values())
    for (const std::uint8_t v : {c.r, c.g, c.b, c.a}) h = (h ^ v) * 0x100000001b3u;
  return h;
}

}  // namespace zoneplate
