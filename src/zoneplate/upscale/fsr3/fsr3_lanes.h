// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/fsr/accumulate_lanes.h"
#include "zoneplate/upscale/fsr3/prepare.h"

/// What the passes of FSR 3 have in common, over a lane type of math/lanes.h.
namespace zoneplate::stages::fsr3 {

using namespace stages::fsr;

constexpr float epsilon = fsr3_epsilon, max_half = fsr3_greatest_half;
constexpr float min_weight = 10 * epsilon;  // of a bilinear sample of depth
constexpr float frame_share = 1.0f / 3;     // of a full history, which a frame adds

/// The length of a motion, in pixels of an output of 3840 × 2160, whatever the output's size is.
template <class F>
[[gnu::always_inline]] inline F velocity_of(F x, F y) {
  const F px = x * F(3840.0f), py = y * F(2160.0f);
  return sqrt(px * px + py * py);
}

/// The velocity from which on a surface at a depth, in metres, counts as moving.
template <class F>
[[gnu::always_inline]] inline F min_velocity(F depth) {
  return mixed(F(0.25f), F(0.75f), saturated(min(depth, F(max_half)) / F(100.0f)));
}

/// A value of [0, 1], rounded as a texture of 8 bits does.
template <class F>
[[gnu::always_inline]] inline F in_255_steps(F value) {
  return floor(saturated(value) * F(255.0f) + F(0.5f)) / F(255.0f);
}

template <class F>
[[gnu::always_inline]] inline F between(const Fsr3Between& plane, std::size_t i) {
  using Int = typename F::Int;
  return bilinear<F>(plane.rows, Int::load(plane.columns[0] + i), Int::load(plane.columns[1] + i),
                     F::load(plane.right + i), F(plane.below));
}

/// Likewise for pixels of four floats.
template <class F>
[[gnu::always_inline]] inline void pixels_between(const Fsr3Between& plane, std::size_t i, F (&out)[4]) {
  F near[4][4];
  for (int k = 0; k < 4; ++k) {
    const std::int32_t* columns = plane.columns[k % 2] + i;
    load_pixels<F>([&](int lane) { return plane.rows[k / 2] + columns[lane]; }, near[k]);
  }
  const F right = F::load(plane.right + i), below = F(plane.below);
  for (int c = 0; c < 4; ++c)
    out[c] = mixed(mixed(near[0][c], near[1][c], right), mixed(near[2][c], near[3][c], right), below);
}

}  // namespace zoneplate::stages::fsr3
