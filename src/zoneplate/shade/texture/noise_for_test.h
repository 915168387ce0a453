// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// An image of random bytes.
inline Rgba8Image noise(int width, int height, std::uint32_t seed) {
  Rgba8Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::uint32_t word = hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed);
      image(x, y) = {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
                     static_cast<std::uint8_t>(word >> 16), static_cast<std::uint8_t>(word >> 24)};
    }
  return image;
}

/// Noise of the light from 2^-8 to 2^16, with alpha.
inline Plane<float4> bright_noise(int width, int height) {
  Plane<float4> image(width, height);
  for (std::uint32_t i = 0; i < image.values().size(); ++i) {
    const auto light = [&](std::uint32_t c) { return std::exp2(24 * unit_float(hash(i, c, 9)) - 8); };
    image.values()[i] = {light(0), light(1), light(2), unit_float(hash(i, 3, 9))};
  }
  return image;
}

}  // namespace zoneplate
