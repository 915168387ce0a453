// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "zoneplate/antialias/post/smaa/exact_areas.h"
#include "zoneplate/math/for_row.h"

/// The kernels of antialias/post/smaa/exact_areas.h over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// The mean of max(y, 0) for y from a to b.
template <class F>
[[gnu::always_inline]] inline F mean_above(F a, F b) {
  const F high = max(a, b), low = min(a, b);
  const F trapezoid = (max(high, F(0)) + max(low, F(0))) * F(0.5f), triangle = high * high / ((high - low) * F(2));
  return select((high > F(0)) & (low < F(0)), triangle, trapezoid);
}

/// The area under a line that rises from a to b over a width, in the unit above the border.
template <class F>
[[gnu::always_inline]] inline F area_above(F a, F b, F width) {
  return (mean_above(a, b) - mean_above(a - F(1), b - F(1))) * width;
}

/// An area of a U shape, rounded as SMAA does; `plain` is the weight of the area that is not rounded.
template <class F>
[[gnu::always_inline]] inline F rounded_area(F area, F plain) {
  const F round = sqrt(area + area) * F(0.5f);
  return round + (area - round) * plain;
}

template <class Full, class One>
[[gnu::flatten]] void exact_orthogonal_areas(const EdgePixels& pixels, float2 offset, float* below, float* above,
                                             std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) {
    const F from = F::load(pixels.from + i), to = F::load(pixels.to + i);
    const F left = F::load(pixels.left + i), length = left + F::load(pixels.right + i) + F(1);
    const F middle = length * F(0.5f), sides = from * to;
    const auto is_step = sides < F(0);
    const auto is_u = sides > F(0);

    // A step is a line between its ends, displaced as a whole. Other shapes are two lines that meet in the middle: on
    // the border, as pixels in the middle of long edges, whose ends are out of reach, keep the border. U shapes of less
    // than 32 pixels without a corner, which are thin objects or the tops of curves, are displaced as a whole, too; an
    // edge between corners is level.
    const auto height = [&](F end) { return end * F(0.5f) + abs(end) * F(offset.y); };
    const F first = height(from), last = height(to);
    const F short_part = F(1) - min(length * F(1 / 32.0f), F(1));
    const F free_part = where(is_u, F(1) - F::load(pixels.is_corner + i));
    const F center = select(is_step, (first + last) * F(0.5f), free_part * short_part * F(offset.y));
    const F slope_before = (center - first) / middle, slope_after = (last - center) / middle;

    // The pixel's column, with its part of each half; x is 0 at the middle.
    const F begin = left - F(offset.x) - middle, end = begin + F(1);
    const F split = min(max(begin, F(0)), end);
    const F y0 = center + slope_before * begin, y1 = center + slope_before * split;
    const F y2 = center + slope_after * split, y3 = center + slope_after * end;
    const F before = split - begin, after = end - split;
    // SMAA rounds short U shapes, whose top one sample at the centre leaves open. Samples around the centre do not:
    // shapes that are displaced with them are not rounded from an eighth of a pixel on, the least offset of SMAA's
    // samples.
    const F plain = F(1) - short_part * (F(1) - free_part * min(F(8 * std::abs(offset.y)), F(1)));
    const auto both = [&](F half, F other) {
      return select(is_u, rounded_area(half, plain) + rounded_area(other, plain), half + other);
    };
    both(area_above(-y0, -y1, before), area_above(-y2, -y3, after)).store(below + i);
    both(area_above(y0, y1, before), area_above(y2, y3, after)).store(above + i);
  });
}

/// The part of a unit square on the side of a line towards which a x + b y grows; `distance` is that of the square's
/// centre, times the length of (a, b).
///
/// Requires  a > 0 or b < 0.
template <class F>
[[gnu::always_inline]] inline F part_beyond(F a, F b, F distance) {
  const F wide = max(abs(a), abs(b)), narrow = min(abs(a), abs(b));
  const F flat = (wide - narrow) * F(0.5f), reach = (wide + narrow) * F(0.5f);
  const F d = min(abs(distance), reach), rest = reach - d;
  const F corner = F(0.5f) - rest * rest / (wide * narrow * F(2));
  const F more = select(d > flat, corner, d / wide);
  return F(0.5f) + select(distance < F(0), -more, more);
}

template <class Full, class One>
[[gnu::flatten]] void exact_diagonal_areas(const DiagonalPixels& pixels, float2 offset, float* below, float* above,
                                           std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) {
    using Int = typename F::Int;
    const Int lines = Int::load(pixels.lines + i);
    const F left = F::load(pixels.left + i), length = left + F::load(pixels.right + i) + F(1);
    const auto bit = [&](int b) { return select((lines & Int(1 << b)) > Int(0), F(1), F(0)); };
    F sum_below(0), sum_above(0);
    for (int line = 0; line < 8; line += 4) {
      const F x = bit(line), y = bit(line + 1);
      const F a = length + bit(line + 3) - y, b = x - length - bit(line + 2);
      const F from_x = left + F(0.5f) - x - F(offset.x), from_y = left + F(0.5f) - y - F(offset.y);
      sum_below = sum_below + (F(1) - part_beyond(a, b, a * (from_x + F(1)) + b * from_y));
      sum_above = sum_above + part_beyond(a, b, a * (from_x + F(1)) + b * (from_y + F(1)));
    }
    (sum_below * F(0.5f)).store(below + i);
    (sum_above * F(0.5f)).store(above + i);
  });
}

template <class Full, class One>
constexpr AreaKernels exact_areas() {
  return {.orthogonal = &exact_orthogonal_areas<Full, One>, .diagonal = &exact_diagonal_areas<Full, One>};
}

}  // namespace zoneplate::stages
