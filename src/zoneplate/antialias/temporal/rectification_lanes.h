// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/temporal/color_lanes.h"
#include "zoneplate/antialias/temporal/resolve.h"

/// The 3 × 3 colours of the current frame and what they allow history to be, over a lane type of math/lanes.h.
///
/// All sums are of differences from the middle colour, so that equal colours have no variance and their own value as
/// mean, exactly.
namespace zoneplate::stages {

///
/// Differences are computed where they are used: nine colours of four channels do not fit into a processor's registers.
template <class F>
class Neighborhood {
 public:
  Rgba<F> middle;

  [[gnu::always_inline]] Neighborhood(const antialias::TemporalRow& row, std::ptrdiff_t i)
      : middle(Rgba<F>::load(row.color, i)), color_(row.color), i_(i) {}

  /// Colour k, by row.
  [[gnu::always_inline]] Rgba<F> color(int k) const {
    return Rgba<F>::load(color_, i_ + k % 3 - 1 + (k / 3 - 1) * color_.stride());
  }

  /// The difference of colour k, by row, from the middle; that of number 4 is 0.
  [[gnu::always_inline]] Rgba<F> difference(int k) const { return color(k) - middle; }

  /// True if all lanes' colours have one value each.
  [[gnu::always_inline]] bool is_flat() const {
#pragma GCC unroll 9
    for (int k = 0; k < 9; ++k)
      if (k != 4 && !all(color(k) == middle)) return false;
    return true;
  }

  /// The mean with the weights of a kernel.
  [[gnu::always_inline]] Rgba<F> mean(const float (&kernel)[9]) const {
    Rgba<F> sum = difference(0) * F(kernel[0]);
    for (int k = 1; k < 9; ++k) sum = sum + difference(k) * F(kernel[k]);
    return max(middle + sum, Rgba<F>::all(F(0.0f)));
  }

 private:
  ColorPlanes<const float> color_;
  std::ptrdiff_t i_;
};

/// The least and the greatest difference from the middle that history may have.
template <class F>
struct DifferenceBox {
  Rgba<F> low, high;
};

/// Boxes of nine differences d(0) to d(8).
template <class F, class Differences>
[[gnu::always_inline]] inline DifferenceBox<F> extremes(const Differences& d) {
  DifferenceBox<F> out{d(4), d(4)};
#pragma GCC unroll 9
  for (int k = 0; k < 9; ++k) {
    const Rgba<F> c = d(k);
    out.low = min(out.low, c), out.high = max(out.high, c);
  }
  return out;
}

template <class F, class Differences>
[[gnu::always_inline]] inline DifferenceBox<F> rounded_extremes(const Differences& d) {
  const DifferenceBox<F> square = extremes<F>(d);
  DifferenceBox<F> plus{d(4), d(4)};
  for (const int k : {1, 3, 5, 7}) {
    const Rgba<F> c = d(k);
    plus.low = min(plus.low, c), plus.high = max(plus.high, c);
  }
  const F half(0.5f);
  return {(square.low + plus.low) * half, (square.high + plus.high) * half};
}

/// The sums of nine differences and of their squares.
template <class F>
struct Moments {
  Rgba<F> sum, squares;

  [[gnu::always_inline]] explicit Moments(const Rgba<F>& first) : sum(first), squares(first * first) {}
  [[gnu::always_inline]] void add(const Rgba<F>& c) { sum = sum + c, squares = squares + c * c; }
  /// The mean ± gamma standard deviations.
  ///
  /// Source    Salvi, An Excursion in Temporal Supersampling, GDC 2016.
  [[gnu::always_inline]] DifferenceBox<F> box(F gamma) const {
    const F ninth(1.0f / 9);
    const Rgba<F> mean = sum * ninth, variance = squares * ninth - mean * mean;
    Rgba<F> radius;
    for (int c = 0; c < 4; ++c) radius.c[c] = gamma * sqrt(max(variance.c[c], F(0.0f)));
    return {mean - radius, mean + radius};
  }
};

template <class F, class Differences>
[[gnu::always_inline]] inline DifferenceBox<F> variance_box(const Differences& d, F gamma) {
  Moments<F> moments(d(0));
#pragma GCC unroll 9
  for (int k = 1; k < 9; ++k) moments.add(d(k));
  return moments.box(gamma);
}

template <class F, class Differences>
[[gnu::always_inline]] inline DifferenceBox<F> box_of(const Differences& d, antialias::TemporalParts::Box box,
                                                      F gamma) {
  using Box = antialias::TemporalParts::Box;
  if (box == Box::Extremes) return extremes<F>(d);
  if (box == Box::Rounded) return rounded_extremes<F>(d);
  return variance_box(d, gamma);
}

/// The colour on the way from the box's centre to `d` that is inside the box.
template <class F>
[[gnu::always_inline]] inline Rgba<F> clipped(const Rgba<F>& d, const DifferenceBox<F>& box) {
  const F half(0.5f), one(1.0f);
  const Rgba<F> centre = (box.low + box.high) * half, extent = (box.high - box.low) * half, offset = d - centre;
  auto is_outside = abs(offset.c[0]) > extent.c[0];
  for (int c = 1; c < 4; ++c) is_outside = is_outside | (abs(offset.c[c]) > extent.c[c]);
  if (none(is_outside)) return centre + offset;
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
  const auto turned_if = [&](const Rgba<F>& c) { return is_turned ? scaled_ycocg_of(c) : c; };
  const auto turned = [&](int k) { return scaled_ycocg_of(around.difference(k)); };
  const auto plain = [&](int k) { return around.difference(k); };
  const Rgba<F> difference = history - around.middle, d = turned_if(difference);
  if (parts.box == antialias::TemporalParts::Box::Both) {
    const Rgba<F> first = around.difference(0), zero = Rgba<F>::all(F(0.0f));
    Moments<F> moments(turned_if(first));
    DifferenceBox<F> limits{min(zero, first), max(zero, first)};
#pragma GCC unroll 9
    for (int k = 1; k < 9; ++k) {
      const Rgba<F> c = around.difference(k);
      moments.add(turned_if(c));
      limits.low = min(limits.low, c), limits.high = max(limits.high, c);
    }
    const DifferenceBox<F> box = moments.box(gamma);
    const Rgba<F> inside =
        parts.rectification == Rectification::Clip ? clipped(d, box) : min(max(d, box.low), box.high);
    const Rgba<F> color = select(inside == d, difference, is_turned ? rgb_of_scaled(inside) : inside);
    // After the clip, so that its centre stays the mean; and in R, G, B, since corners of a box in Y, Co, Cg are
    // colours with less of a channel than any of the nine.
    const Rgba<F> limited = min(max(color, limits.low), limits.high);
    return select(limited == difference, history, max(around.middle + limited, zero));
  }
  const DifferenceBox<F> box = is_turned ? box_of(turned, parts.box, gamma) : box_of(plain, parts.box, gamma);
  const Rgba<F> inside = parts.rectification == Rectification::Clip ? clipped(d, box) : min(max(d, box.low), box.high);
  const Rgba<F> moved = around.middle + (is_turned ? rgb_of_scaled(inside) : inside);
  return select(inside == d, history, max(moved, Rgba<F>::all(F(0.0f))));
}

}  // namespace zoneplate::stages
