// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/post/edge_lanes.h"
#include "zoneplate/antialias/post/smaa/edge_detection.h"
#include "zoneplate/math/for_row.h"

/// The kernels of antialias/post/smaa/edge_detection.h over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// The thresholds of the left and top borders of some pixels, as numbers of a lane type F or F::Int.
template <class Number>
struct BorderThresholds {
  Number left, top;
};
template <class Number>
[[gnu::always_inline]] inline Number number_of(float threshold) {
  return Number(threshold);
}
template <class Number>
[[gnu::always_inline]] inline Number number_of(std::uint32_t threshold) {
  return Number(static_cast<std::int32_t>(threshold));
}

template <class F, class Number, class T>
[[gnu::always_inline]] inline BorderThresholds<Number> thresholds_of(T threshold, const std::uint8_t*) {
  return {number_of<Number>(threshold), number_of<Number>(threshold)};
}
/// `crossed` is the initial contents of the edges.
template <class F, class Number, class T>
[[gnu::always_inline]] inline BorderThresholds<Number> thresholds_of(PredicatedThreshold<T> threshold,
                                                                     const std::uint8_t* crossed) {
  using Int = typename F::Int;
  const Int bits = Int::load_from(crossed);
  const auto of = [&](int border) {
    return select((bits & Int(border)) > Int(0), number_of<Number>(threshold.crossed),
                  number_of<Number>(threshold.plain));
  };
  return {of(1), of(2)};
}

template <class Full, class One, class Threshold>
[[gnu::flatten]] void smaa_luma_edges(const EdgeRows<float>& rows, Threshold threshold, std::uint8_t* edges,
                                      std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) {
    const float* here = rows.row[2] + i;
    const auto least = thresholds_of<F, F>(threshold, edges + i);
    const F m = F::load(here), l = F::load(here - 1), t = F::load(rows.row[1] + i);
    const F to_left = abs(m - l), to_top = abs(m - t);
    const auto is_left = to_left >= least.left, is_top = to_top >= least.top;
    if (none(is_left | is_top)) return F::Int::store_zeros(edges + i);
    const F to_right = abs(m - F::load(here + 1)), to_bottom = abs(m - F::load(rows.row[3] + i));
    const F far_left = abs(l - F::load(here - 2)), far_top = abs(t - F::load(rows.row[0] + i));
    const F greatest = max(max(max(to_left, to_top), max(to_right, to_bottom)), max(far_left, far_top));
    store_edges<F>(is_left & (to_left + to_left >= greatest), is_top & (to_top + to_top >= greatest), edges + i);
  });
}

// As in the original, the pixel itself is compared with the second neighbour, not the neighbour with its next one.
template <class Full, class One, class Threshold>
[[gnu::flatten]] void smaa_color_edges(const EdgeRows<std::uint32_t>& rows, Threshold threshold, std::uint8_t* edges,
                                       std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) {
    using Int = typename F::Int;
    const auto pixels = [&](int row, int x) {
      return Int::load(reinterpret_cast<const std::int32_t*>(rows.row[row] + i) + x);
    };
    const Int one(1), m = pixels(2, 0);
    const auto to = [&](int row, int x) { return color_difference(m, pixels(row, x)); };
    const auto least = thresholds_of<F, Int>(threshold, edges + i);
    const Int to_left = to(2, -1), to_top = to(1, 0), far_left = to(2, -2), far_top = to(0, 0);
    const Int near = max(max(to_left, to_top), max(to(2, 1), to(3, 0)));
    const Int below_half = max(near, max(far_left, far_top)) - one;
    store_edges<F>((to_left > least.left - one) & (to_left + to_left > below_half),
                   (to_top > least.top - one) & (to_top + to_top > below_half), edges + i);
  });
}

template <class Full, class One>
constexpr SmaaKernels smaa_edge_detection() {
  return {.luma_edges = &smaa_luma_edges<Full, One, float>,
          .color_edges = &smaa_color_edges<Full, One, std::uint32_t>,
          .predicated_luma_edges = &smaa_luma_edges<Full, One, PredicatedThreshold<float>>,
          .predicated_color_edges = &smaa_color_edges<Full, One, PredicatedThreshold<std::uint32_t>>};
}

}  // namespace zoneplate::stages
