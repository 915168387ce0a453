// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace zoneplate::upscale {

/// The input pixels at or before output pixels along one axis, and the distance of the outputs' centres from them, in
/// [0, 1).
struct Axis {
  std::vector<int> first;
  std::vector<float> beyond;

  /// Output pixels begin to end - 1, clamped to the `to` pixels of the output, for an input of `from` pixels. The two
  /// arithmetics differ by rounding, which decides about the phases of filters.
  static Axis by_step(int begin, int end, int to, int from) {
    const float step = static_cast<float>(from) * (1 / static_cast<float>(to)), shift = 0.5f * step - 0.5f;
    return Axis(begin, end, to, [=](float o) { return o * step + shift; });
  }
  static Axis by_centre(int begin, int end, int to, int from) {
    const float step = static_cast<float>(from) / static_cast<float>(to);
    return Axis(begin, end, to, [=](float o) { return (0.5f + o) * step - 0.5f; });
  }

 private:
  template <class Place>
  Axis(int begin, int end, int to, const Place& place_of) {
    for (int o = begin; o < end; ++o) {
      const float place = place_of(static_cast<float>(std::clamp(o, 0, to - 1))), floored = std::floor(place);
      first.push_back(static_cast<int>(floored));
      beyond.push_back(place - floored);
    }
  }
};

}  // namespace zoneplate::upscale
