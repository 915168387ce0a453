// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/dither.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr float just_below_half = 0x1.fffffep-2f;  // rounds as quantize8 does

std::uint8_t code(float x, float u) {
  const float scaled = 255 * (x > 0 ? std::min(x, 1.0f) : 0.0f);
  const float whole = std::floor(scaled);
  return static_cast<std::uint8_t>(whole + (scaled - whole > u ? 1.0f : 0.0f));
}

}  // namespace

Rgba8Image quantize8_dithered(const DisplayImage& image) {
  Rgba8Image out(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const Display& c = image(x, y);
      const auto u = [&](std::uint32_t channel) {
        return unit_float(hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), channel));
      };
      out(x, y) = {code(c.r, u(0)), code(c.g, u(1)), code(c.b, u(2)), code(c.a, just_below_half)};
    }
  return out;
}

}  // namespace zoneplate
