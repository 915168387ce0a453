// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/false_color.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/math/elementary.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/raster/types/batch.h"

namespace zoneplate::cli {

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

}  // namespace zoneplate::cli
