// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/environment/environment_view.h"

namespace zoneplate {

/// Eight levels of random radiance, of which the first three have larger faces.
struct RandomMap {
  std::vector<float> texels;
  EnvironmentView view;

  RandomMap() {
    view.levels = 8, view.sharpness = 1000, view.levels_per_octave = 7 / log2(1001.0f);
    int count = 0;
    for (int level = 0; level <= view.levels; ++level) {
      view.side[level] = level < 3 ? 12 : 8, view.offset[level] = count;
      view.common_side[level] = level == 1 ? 12 : level > 3 && level < view.levels - 1 ? 8 : 0;
      count += EnvironmentView::faces * (view.side[level] + 2) * (view.side[level] + 2);
    }
    for (int i = 0; i <= 3 * count; ++i) texels.push_back(unit_float(hash(static_cast<std::uint32_t>(i), 9)) - 0.1f);
    view.texels = texels.data();
    for (int c = 0; c < 3; ++c) view.image_from_world[4 * c] = 1, view.tint[c] = 0.5f + static_cast<float>(c);
  }
  /// The roughness of a level.
  float roughness(float level) const {
    return std::sqrt(std::sqrt((exp2(level / view.levels_per_octave) - 1) / view.sharpness));
  }
};

}  // namespace zoneplate
