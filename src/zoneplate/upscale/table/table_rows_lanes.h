// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/table/filter_table.h"
#include "zoneplate/upscale/table/table_rows.h"

/// TableKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

namespace table {

using upscale::FilterTable;

/// The gradients, in square roots of light per pixel, and the coherences at which classes change.
inline constexpr float strength_bounds[] = {0.01f, 0.04f, 0.1f}, coherence_bounds[] = {0.25f, 0.5f};

template <class F>
[[gnu::always_inline]] inline void take_roots(const float* pixels, float* const (&roots)[3], float* luma,
                                              std::ptrdiff_t i) {
  F color[4];
  F::load_fours(pixels + 4 * i, color);
  for (int c = 0; c < 3; ++c) {
    color[c] = sqrt(max(color[c], F(0.0f)));
    color[c].store(roots[c] + i);
  }
  (F(0.2126f) * color[0] + F(0.7152f) * color[1] + F(0.0722f) * color[2]).store(luma + i);
}

template <class F>
[[gnu::always_inline]] inline void take_gradients(const float* const (&luma)[3], const GradientRow& out,
                                                  std::ptrdiff_t i) {
  const F x = (F::load(luma[1] + i + 2) - F::load(luma[1] + i)) * F(0.5f);
  const F y = (F::load(luma[2] + i + 1) - F::load(luma[0] + i + 1)) * F(0.5f);
  (x * x).store(out.xx + i), (x * y).store(out.xy + i), (y * y).store(out.yy + i);
}

/// The number of bounds that a value exceeds, as a float.
template <class F, std::size_t n>
[[gnu::always_inline]] inline F above(F value, const float (&bounds)[n]) {
  F out(0.0f);
  for (const float bound : bounds) out = out + where(value > F(bound), F(1.0f));
  return out;
}

/// The octant of (x, y), counted from +x towards +y: the angle without an arc tangent.
template <class F>
[[gnu::always_inline]] inline F octant(F x, F y) {
  const auto is_below = y < F(0.0f);
  const F u = select(is_below, -x, x), v = select(is_below, -y, y);
  const F quarter = select(u > F(0.0f), where(v >= u, F(1.0f)), select(v > -u, F(2.0f), F(3.0f)));
  return quarter + where(is_below, F(4.0f));
}

template <class F>
[[gnu::always_inline]] inline void classify(const GradientRow (&rows)[5], std::int32_t* classes, std::ptrdiff_t i) {
  constexpr int side = FilterTable::window;
  const auto mean = [&](float* GradientRow::*plane) {
    F sum(0.0f);
    for (int x = 0; x < side; ++x) {
      F column(0.0f);
      for (const GradientRow& row : rows) column = column + F::load(row.*plane + i + x);
      sum = sum + column;
    }
    return sum * F(1.0f / (side * side));
  };
  const F xx = mean(&GradientRow::xx), xy = mean(&GradientRow::xy), yy = mean(&GradientRow::yy);
  const F apart = xx - yy, both = xx + yy, zero(0.0f), half(0.5f);
  const F split = sqrt(apart * apart + F(4.0f) * xy * xy);
  const F first = sqrt(max((both + split) * half, zero)), second = sqrt(max((both - split) * half, zero));
  const F coherence = select(first > zero, (first - second) / max(first + second, F(1e-20f)), zero);
  // The direction of the gradient is half of the angle of this vector.
  const F direction = octant(apart, F(2.0f) * xy);
  const F strength = above(first, strength_bounds) * F(static_cast<float>(FilterTable::coherences));
  const F its_class = (strength + above(coherence, coherence_bounds)) * F(static_cast<float>(FilterTable::directions));
  truncate(its_class + direction).store(classes + i);
}

template <int side, class F>
[[gnu::always_inline]] inline void filter(const TableRow& row, std::ptrdiff_t i) {
  using Int = typename F::Int;
  constexpr int middle = side * side / 2, margin = FilterTable::window / 2, before = margin - side / 2;
  const Int first = Int::load(row.classes + i) * Int(FilterTable::Form{1, side}.taps());
  const F zero(0.0f);
  F is[3], sum[3] = {zero, zero, zero}, low[3] = {zero, zero, zero}, high[3] = {zero, zero, zero};
  for (int c = 0; c < 3; ++c) is[c] = F::load(row.roots[c][margin] + i + margin);
  for (int k = 0, tap = 0; k < side * side; ++k) {
    if (k == middle) continue;
    const int x = before + k % side, y = before + k / side;
    const F weight = F::gather(row.weights + tap++, first);
    const bool is_near = x >= 1 && x <= 3 && y >= 1 && y <= 3;
    for (int c = 0; c < 3; ++c) {
      const F difference = F::load(row.roots[c][y] + i + x) - is[c];
      sum[c] = sum[c] + difference * weight;
      if (is_near) low[c] = min(low[c], difference), high[c] = max(high[c], difference);
    }
  }
  // A pixel that does not change keeps its bits.
  F light[4];
  F::load_fours(row.image + 4 * i, light);
  for (int c = 0; c < 3; ++c) {
    const F change = min(max(sum[c], low[c]), high[c]), root = is[c] + change;
    light[c] = select(change == zero, light[c], root * root);
  }
  F::store_fours(light, row.out + 4 * i);
}

}  // namespace table

template <class Full, class One>
[[gnu::flatten]] void table_take_roots(const float* pixels, float* const (&roots)[3], float* luma, std::size_t n) {
  for_row<Full, One>(
      n, [&]<class F>(std::size_t i) { table::take_roots<F>(pixels, roots, luma, static_cast<std::ptrdiff_t>(i)); });
}

template <class Full, class One>
[[gnu::flatten]] void table_take_gradients(const float* const (&luma)[3], const GradientRow& out, std::size_t n) {
  for_row<Full, One>(
      n, [&]<class F>(std::size_t i) { table::take_gradients<F>(luma, out, static_cast<std::ptrdiff_t>(i)); });
}

template <class Full, class One>
[[gnu::flatten]] void table_classify(const GradientRow (&rows)[5], std::int32_t* classes, std::size_t n) {
  for_row<Full, One>(
      n, [&]<class F>(std::size_t i) { table::classify<F>(rows, classes, static_cast<std::ptrdiff_t>(i)); });
}

template <int side, class Full, class One>
[[gnu::flatten]] void table_filter(const TableRow& row, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) { table::filter<side, F>(row, static_cast<std::ptrdiff_t>(i)); });
}

template <class Full, class One>
constexpr TableKernels table_rows() {
  return {.take_roots = &table_take_roots<Full, One>,
          .take_gradients = &table_take_gradients<Full, One>,
          .classify = &table_classify<Full, One>,
          .filter3 = &table_filter<3, Full, One>,
          .filter5 = &table_filter<5, Full, One>};
}

}  // namespace zoneplate::stages
