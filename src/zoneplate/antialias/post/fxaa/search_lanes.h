// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/post/fxaa/search.h"

namespace zoneplate::stages {

/// FxaaKernels::mix_row for pixel i of n.
[[gnu::always_inline]] inline void fxaa_mix_pixel(const std::uint8_t* above, const std::uint8_t* here,
                                                  const std::uint8_t* below, const FxaaEnds& ends, std::uint8_t* out,
                                                  std::size_t i, std::size_t n) {
  const bool is_level = ends.flags[i] & FxaaEnds::level, is_second = ends.flags[i] & FxaaEnds::second_side;
  const std::size_t left = i > 0 ? i - 1 : 0, right = i + 1 < n ? i + 1 : i;
  const std::uint8_t* there = is_level ? (is_second ? below : above) + 4 * i : here + 4 * (is_second ? right : left);
  for (std::size_t c = 0; c < 4; ++c) {
    const float from = here[4 * i + c], to = there[c];
    out[4 * i + c] = static_cast<std::uint8_t>(from + (to - from) * ends.shift[i] + 0.5f);
  }
}

}  // namespace zoneplate::stages
