// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace zoneplate::upscale::fsr {

/// The pixels of a plane around the centres of output pixels along one axis, clamped to the plane.
struct BilinearAxis {
  std::vector<std::int32_t> first, second;
  std::vector<float> beyond;  ///< distance from the first, in [0, 1)

  /// For `to` output pixels and a plane of `size` that covers the same image, shifted by a share of it.
  BilinearAxis(int to, int size, float shift) {
    const auto width = static_cast<float>(size);
    for (int o = 0; o < to; ++o) {
      const float u = (static_cast<float>(o) + 0.5f) / static_cast<float>(to);
      const float place = std::clamp((u + shift) * width, 0.5f, width - 0.5f) - 0.5f, floored = std::floor(place);
      first.push_back(static_cast<std::int32_t>(floored));
      second.push_back(std::min(first.back() + 1, size - 1));
      beyond.push_back(place - floored);
    }
  }
};

/// The samples of a jittered frame around output pixels along one axis.
struct SampleAxis {
  std::vector<std::int32_t> index[3];  ///< of the three nearest, in the frame with a border of one pixel
  std::vector<float> offset[3];        ///< from the output pixel's centre, in frame pixels
  std::vector<float> is_inside[3];     ///< 1 in the frame, 0 in its border
  std::vector<std::int32_t> nearest;   ///< the pixel that contains the centre, in the frame
  std::vector<float> centre;           ///< of the output pixel in [0, 1]

  SampleAxis(int to, int from, float jitter) {
    const float step = static_cast<float>(from) / static_cast<float>(to);
    for (int o = 0; o < to; ++o) {
      const float place = (static_cast<float>(o) + 0.5f) * step, floored = std::floor(place);
      const float sample = floored + 0.5f - jitter;
      // The three samples nearest to the place, the nearest side first.
      const bool is_flipped = sample > place;
      for (int k = 0; k < 3; ++k) {
        const int away = is_flipped ? 1 - k : k - 1, pixel = static_cast<int>(floored) + away;
        index[k].push_back(pixel + 1);
        offset[k].push_back(sample - place + static_cast<float>(away));
        is_inside[k].push_back(pixel >= 0 && pixel < from ? 1.0f : 0.0f);
      }
      const float u = (static_cast<float>(o) + 0.5f) / static_cast<float>(to);
      centre.push_back(u);
      nearest.push_back(std::min(static_cast<int>(u * static_cast<float>(from)), from - 1));
    }
  }
};

/// Indices times `factor`, plus `offset`.
inline std::vector<std::int32_t> scaled(std::vector<std::int32_t> list, int factor, int offset = 0) {
  for (std::int32_t& i : list) i = i * factor + offset;
  return list;
}

}  // namespace zoneplate::upscale::fsr
