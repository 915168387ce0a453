// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/temporal/color_lanes.h"
#include "zoneplate/antialias/temporal/resolve.h"

/// The 3 × 3 colours of the current frame and what they allow history to be, over a lane type of math/lanes.h.
///
/// All sums are of differences from the middle colour, so that equal colours have no variance and their own value as
/// mean, exactly.
namespace zoneplate::stages {

template <class F>
struct Neighborhood {
  Rgba<F> middle;
  Rgba<F> difference[9];  ///< from the middle, by row; that of number 4 is 0

  [[gnu::always_inline]] Neighborhood(const antialias::TemporalRow& row, std::ptrdiff_t i) {
    middle = Rgba<F>::load(row.color + 4 * i);
    for (int k = 0; k < 9; ++k)
      difference[k] = Rgba<F>::load(row.color + 4 * (i + k % 3 - 1) + (k / 3 - 1) * row.color_stride) - middle;
  }

  /// The mean with the weights of a kernel.
  [[gnu::always_inline]] Rgba<F> mean(const float (&kernel)[9]) const {
    Rgba<F> sum = difference[0] * F(kernel[0]);
    for (int k = 1; k < 9; ++k) sum = sum + difference[k] * F(kernel[k]);
    return max(middle + sum, Rgba<F>::all(F(0.0f)));
  }
};

/// The least and the greatest difference from the middle that history may have.
template <class F>
struct DifferenceBox {
  Rgba<F> low, high;
};

template <class F>
[[gnu::always_inline]] inline DifferenceBox<F> extremes(const Rgba<F> (&d)[9]) {
  DifferenceBox<F> out{d[4], d[4]};
  for (int k = 0; k < 9; ++k) out.low = min(out.low, d[k]), out.high = max(out.high, d[k]);
  return out;
}

template <class F>
[[gnu::always_inline]] inline DifferenceBox<F> rounded_extremes(const Rgba<F> (&d)[9]) {
  const DifferenceBox<F> square = extremes(d);
  DifferenceBox<F> plus{d[4], d[4]};
  for (const int k : {1, 3, 5, 7}) plus.low = min(plus.low, d[k]), plus.high = max(plus.high, d[k]);
  const F half(0.5f);
  return {(square.low + plus.low) * half, (square.high + plus.high) * half};
}

/// Source    Salvi, An Excursion in Temporal Supersampling, GDC 2016.
template <class F>
[[gnu::always_inline]] inline DifferenceBox<F> variance_box(const Rgba<F> (&d)[9], F gamma) {
  Rgba<F> sum = d[0], squares = d[0] * d[0];
  for (int k = 1; k < 9; ++k) sum = sum + d[k], squares = squares + d[k] * d[k];
  const F ninth(1.0f / 9);
  const Rgba<F> mean = sum * ninth, variance = squares * ninth - mean * mean;
  Rgba<F> radius;
  for (int c = 0; c < 4; ++c) radius.c[c] = gamma * sqrt(max(variance.c[c], F(0.0f)));
  return {mean - radius, mean + radius};
}

template <class F>
[[gnu::always_inline]] inline DifferenceBox<F> box_of(const Rgba<F> (&d)[9], antialias::TemporalParts::Box box,
                                                      F gamma) {
  using Box = antialias::TemporalParts::Box;
  if (box == Box::Extremes) return extremes(d);
  if (box == Box::Rounded) return rounded_extremes(d);
  const DifferenceBox<F> spread = variance_box(d, gamma);
  if (box == Box::Variance) return spread;
  const DifferenceBox<F> limits = extremes(d);
  return {min(max(spread.low, limits.low), limits.high), max(min(spread.high, limits.high), limits.low)};
}

/// The colour on the way from the box's centre to `d` that is inside the box.
template <class F>
[[gnu::always_inline]] inline Rgba<F> clipped(const Rgba<F>& d, const DifferenceBox<F>& box) {
  const F half(0.5f), one(1.0f);
  const Rgba<F> centre = (box.low + box.high) * half, extent = (box.high - box.low) * half, offset = d - centre;
  F part(1.0f);
  for (int c = 0; c < 4; ++c) {
    const F distance = abs(offset.c[c]);
    part = min(part, select(distance > extent.c[c], extent.c[c] / distance, one));
  }
  return centre + offset * part;
}

/// History that the neighbourhood allows. History inside the box keeps its bits.
template <class F>
[[gnu::always_inline]] inline Rgba<F> rectified(const Rgba<F>& history, const Neighborhood<F>& around,
                                                const antialias::TemporalParts& parts, F gamma) {
  using Rectification = antialias::TemporalParts::Rectification;
  if (parts.rectification == Rectification::None) return history;
  const bool is_turned = parts.is_ycocg;
  Rgba<F> allowed[9];
  for (int k = 0; k < 9; ++k) allowed[k] = is_turned ? ycocg_of(around.difference[k]) : around.difference[k];
  const DifferenceBox<F> box = box_of(allowed, parts.box, gamma);
  const Rgba<F> difference = history - around.middle, d = is_turned ? ycocg_of(difference) : difference;
  const Rgba<F> inside = parts.rectification == Rectification::Clip ? clipped(d, box) : min(max(d, box.low), box.high);
  const Rgba<F> moved = around.middle + (is_turned ? rgb_of(inside) : inside);
  return select(inside == d, history, max(moved, Rgba<F>::all(F(0.0f))));
}

}  // namespace zoneplate::stages
