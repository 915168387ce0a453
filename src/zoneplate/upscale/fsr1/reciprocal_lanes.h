// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Reciprocals over a lane type of math/lanes.h: correctly rounded, or as AMD's shaders approximate them.
///
/// Source    AMD, ffx_core_gpu_common.h: ffxApproximateReciprocal and its relatives; Lottes, GPUOpen, 2021.
namespace zoneplate::stages {

/// Of a positive number. The approximation is finite for 0.
template <bool is_exact, class F>
[[gnu::always_inline]] inline F reciprocal(F a) {
  using Int = typename F::Int;
  if constexpr (is_exact) return F(1.0f) / a;
  return F::of_bits(Int(0x7ef07ebb) - as_int(a));
}

/// The same with a step of Newton's method.
template <bool is_exact, class F>
[[gnu::always_inline]] inline F medium_reciprocal(F a) {
  using Int = typename F::Int;
  if constexpr (is_exact) return F(1.0f) / a;
  const F b = F::of_bits(Int(0x7ef19fff) - as_int(a));
  return b * (-b * a + F(2.0f));
}

/// Of the square root of a positive number.
template <bool is_exact, class F>
[[gnu::always_inline]] inline F reciprocal_root(F a) {
  using Int = typename F::Int;
  if constexpr (is_exact) return F(1.0f) / sqrt(a);
  return F::of_bits(Int(0x5f347d74) - as_int(a).template shifted_right<1>());
}

}  // namespace zoneplate::stages
