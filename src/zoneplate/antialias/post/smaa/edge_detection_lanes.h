#pragma once

#include "zoneplate/antialias/post/edge_lanes.h"
#include "zoneplate/antialias/post/smaa/edge_detection.h"
#include "zoneplate/math/for_row.h"

/// The edges by luma of SmaaKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// The thresholds of the left and top borders of some pixels.
template <class F>
struct BorderThresholds {
  F left, top;
};
template <class F>
[[gnu::always_inline]] inline BorderThresholds<F> thresholds_of(float threshold, const std::uint8_t*) {
  return {F(threshold), F(threshold)};
}
/// `crossed`: what the edges hold before.
template <class F>
[[gnu::always_inline]] inline BorderThresholds<F> thresholds_of(const PredicatedThreshold<float>& threshold,
                                                                const std::uint8_t* crossed) {
  using Int = typename F::Int;
  const Int bits = Int::load_from(crossed);
  const F plain(threshold.plain), other(threshold.crossed);
  const auto of = [&](int border) { return select((bits & Int(border)) > Int(0), other, plain); };
  return {of(1), of(2)};
}

template <class Full, class One, class Threshold>
[[gnu::always_inline]] inline void find_luma_edges(const EdgeRows<float>& rows, const Threshold& threshold,
                                                   std::uint8_t* edges, std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) {
    const float* here = rows.row[2] + i;
    const auto least = thresholds_of<F>(threshold, edges + i);
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

template <class Full, class One>
[[gnu::flatten]] void smaa_luma_edges(const EdgeRows<float>& rows, float threshold, std::uint8_t* edges,
                                      std::size_t n) {
  find_luma_edges<Full, One>(rows, threshold, edges, n);
}

template <class Full, class One>
[[gnu::flatten]] void smaa_predicated_luma_edges(const EdgeRows<float>& rows,
                                                 const PredicatedThreshold<float>& threshold, std::uint8_t* edges,
                                                 std::size_t n) {
  find_luma_edges<Full, One>(rows, threshold, edges, n);
}

}  // namespace zoneplate::stages
