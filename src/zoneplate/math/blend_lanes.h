// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Clamping and interpolation over the lane types of math/lanes.h.
namespace zoneplate::stages {

/// The value clamped to [0, 1].
template <class F>
[[gnu::always_inline]] inline F saturated(F v) {
  return min(max(v, F(0.0f)), F(1.0f));
}

/// a at t = 0, about b at t = 1.
template <class F>
[[gnu::always_inline]] inline F mixed(F a, F b, F t) {
  return a + (b - a) * t;
}

}  // namespace zoneplate::stages
