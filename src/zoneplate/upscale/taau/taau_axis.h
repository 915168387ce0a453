// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace zoneplate::upscale {

/// The samples of a jittered frame around output pixels along one axis.
struct TaauAxis {
  std::vector<std::int32_t> around[3];  ///< pixels of the frame: of the nearest sample, and those before and after it
  std::vector<float> offset;            ///< of the output pixel's centre from the middle sample, in frame pixels

  TaauAxis(int to, int from, float jitter) {
    for (int o = 0; o < to; ++o) {
      const float place = (static_cast<float>(o) + 0.5f) * static_cast<float>(from) / static_cast<float>(to) + jitter;
      const float floored = std::floor(place);
      for (int k = 0; k < 3; ++k) around[k].push_back(std::clamp(static_cast<int>(floored) + k - 1, 0, from - 1));
      offset.push_back(place - floored - 0.5f);
    }
  }
};

}  // namespace zoneplate::upscale
