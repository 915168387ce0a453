// SPDX-License-Identifier: Apache-2.0
// Loops over a row by vectors; included by *_simd.cpp files only.
#if defined(ZONEPLATE_MATH_FOR_LANES_SIMD_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ZONEPLATE_MATH_FOR_LANES_SIMD_H_
#undef ZONEPLATE_MATH_FOR_LANES_SIMD_H_
#else
#define ZONEPLATE_MATH_FOR_LANES_SIMD_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Calls some(d, i) for the values of a row of n, starting at i, as many as d has lanes: first for whole vectors of at
/// most eight lanes, then for single values.
template <class T = float, class Some>
HWY_INLINE void for_lanes(std::size_t n, Some some) {
  const hn::CappedTag<T, 8> full;
  const hn::CappedTag<T, 1> one;
  std::size_t i = 0;
  for (; i + hn::Lanes(full) <= n; i += hn::Lanes(full)) some(full, i);
  for (; i < n; ++i) some(one, i);
}

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
