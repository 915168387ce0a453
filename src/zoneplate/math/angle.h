// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zoneplate {

struct SineCosine {
  double sine = 0, cosine = 1;
};

/// The sine and cosine of an angle in double, for one-time set-up of cameras and procedural scenes.
///
/// Requires  |angle| <= 1000.
/// Exact     within 1e-15 (|angle| <= 7), the same bits on every machine: sums of the power series in a fixed order.
SineCosine sine_cosine(double angle);

/// The sine and cosine of the angle `quadrant` · π/2 + rest, given those of the rest.
constexpr SineCosine turned(std::uint64_t quadrant, SineCosine rest) {
  switch (quadrant & 3) {
    case 0:
      return rest;
    case 1:
      return {rest.cosine, -rest.sine};
    case 2:
      return {-rest.sine, -rest.cosine};
    default:
      return {-rest.cosine, rest.sine};
  }
}

}  // namespace zoneplate
