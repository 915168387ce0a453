// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/output/false_color.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/math/elementary.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

DepthCodes depth_codes(const Plane<float>& depth) {
  DepthCodes out{Plane<std::uint16_t>(depth.width(), depth.height(), 65535), std::numeric_limits<float>::infinity(),
                 -std::numeric_limits<float>::infinity()};
  for (const float d : depth.values()) {
    if (!std::isfinite(d)) continue;
    out.near = std::min(out.near, d);
    out.far = std::max(out.far, d);
  }
  const float range = out.far > out.near ? out.far - out.near : 1.0f;
  for (std::size_t i = 0; i < depth.values().size(); ++i) {
    const float d = depth.values()[i];
    if (!std::isfinite(d)) continue;
    const float share = std::clamp((d - out.near) / range, 0.0f, 1.0f);
    out.image.values()[i] = static_cast<std::uint16_t>(std::floor(share * 65534 + 0.5f));
  }
  return out;
}

Rgba8 circle_color(float turn, float saturation) {
  const auto channel = [&](float offset) {
    const float t = 6 * (turn + offset), from = t - 6 * std::floor(t / 6);
    const float value = std::clamp(std::abs(from - 3) - 1, 0.0f, 1.0f), shown = 1 - saturation * (1 - value);
    return static_cast<std::uint8_t>(std::floor((shown > 0 ? std::min(shown, 1.0f) : 0.0f) * 255 + 0.5f));
  };
  return {channel(0), channel(2.0f / 3), channel(1.0f / 3), 255};
}

Rgba8 mip_level_color(float level) {
  if (level == FragmentOutputs::no_mip_level) return {0, 0, 0, 0};
  return circle_color(std::clamp(level, 0.0f, 7.5f) / 8, std::clamp(level + 1, 0.0f, 1.0f));
}

Rgba8 anisotropy_color(float ratio) { return ratio > 0 ? metrics::magma(log2(ratio) / 4) : Rgba8{0, 0, 0, 0}; }

}  // namespace zoneplate
