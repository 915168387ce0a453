// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/temporal/history_lanes.h"
#include "zoneplate/antialias/temporal/rectification_lanes.h"
#include "zoneplate/antialias/temporal/weight_lanes.h"
#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/pixel_lanes.h"
#include "zoneplate/upscale/taau/taau_row.h"

/// TaauKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

namespace taau {

/// The weight of a sample at a distance from the output pixel's centre, whose square is in output pixels.
template <class F>
[[gnu::always_inline]] inline F sample_weight(F distance2) {
  const F x2 = saturated(distance2);
  return (F(0.905f) * x2 - F(1.9f)) * x2 + F(1.0f);
}

/// The motion, in output pixels, of the nearest surface among the middle sample and its diagonal neighbours.
template <class F>
[[gnu::always_inline]] inline Followed<F> nearest_surface(const TaauFrame& frame, const TaauRow& row,
                                                          const typename F::Int (&columns)[3]) {
  const auto at = [&](const float* const(&plane)[3], int r, int c) { return F::gather(plane[r], columns[c]); };
  Followed<F> best{};
  best.nearness = at(row.nearness, 1, 1);
  best.motion[0] = at(row.motion_x, 1, 1), best.motion[1] = at(row.motion_y, 1, 1);
  for (int r = 0; r < 3; r += 2)
    for (int c = 0; c < 3; c += 2) {
      const F nearness = at(row.nearness, r, c);
      const auto is_nearer = nearness > best.nearness;
      if (none(is_nearer)) continue;
      best.nearness = select(is_nearer, nearness, best.nearness);
      best.motion[0] = select(is_nearer, at(row.motion_x, r, c), best.motion[0]);
      best.motion[1] = select(is_nearer, at(row.motion_y, r, c), best.motion[1]);
    }
  for (int k = 0; k < 2; ++k) best.motion[k] = best.motion[k] * F(frame.scale[k]);
  return best;
}

template <class F>
[[gnu::always_inline]] inline void resolve_pixels(const TaauFrame& frame, const TaauRow& row,
                                                  const TemporalRow& history_row, std::ptrdiff_t i) {
  using Int = typename F::Int;
  const F zero(0.0f), one(1.0f);
  Int columns[3];
  for (int c = 0; c < 3; ++c) columns[c] = Int::load(row.columns[c] + i);

  // The frame's samples: differences from the middle one, whose mean and range take the others in by distance.
  const auto pixel = [&](int r, int c) {
    std::int32_t column[F::lanes];
    columns[c].store(column);
    Rgba<F> out;
    load_pixels<F>([&](int lane) { return row.color[r] + std::ptrdiff_t{4} * column[lane]; }, out.c);
    return out;
  };
  const Rgba<F> middle = pixel(1, 1);
  Rgba<F> difference[9];
  for (int k = 0; k < 9; ++k) difference[k] = pixel(k / 3, k % 3) - middle;
  const F dx = F::load(row.dx + i), dy = F(row.dy), reach2 = F(frame.radius * frame.radius);
  Rgba<F> sum = Rgba<F>::all(zero);
  DifferenceBox<F> box{sum, sum};
  F density = zero, weights = zero;
  for (int k = 0; k < 9; ++k) {
    const F x = F(static_cast<float>(k % 3 - 1)) - dx, y = F(static_cast<float>(k / 3 - 1)) - dy;
    const F u = x * F(frame.scale[0]), v = y * F(frame.scale[1]);
    const F weight = sample_weight(u * u + v * v);
    const F weighed = weight * factor_of(middle + difference[k], TemporalParts::Weighting::Luma);
    sum = sum + difference[k] * weighed;
    density = density + weight, weights = weights + weighed;
    const auto is_near = reach2 > x * x + y * y;
    const Rgba<F> limit = select(is_near, ycocg_of(difference[k]), Rgba<F>::all(zero));
    box.low = min(box.low, limit), box.high = max(box.high, limit);
  }
  const Rgba<F> current = middle + sum * (one / weights);
  if (frame.is_first) {
    current.store(row.resolved + 4 * i);
    return;
  }

  const Source<F> source(nearest_surface<F>(frame, row, columns), history_row, i);
  constexpr TemporalParts parts{.filter = TemporalParts::Filter::CatmullRom5};
  const Rgba<F> past = history_of(frame.history, history_row, parts, source, i), d = ycocg_of(past - middle);
  const Rgba<F> inside = min(max(d, box.low), box.high);
  const Rgba<F> history = select(inside == d, past, max(middle + rgb_of(inside), Rgba<F>::all(zero)));
  const F moving = saturated(speed_of(source) * F(1.0f / 20));
  const F share = mixed(density * F(0.04f), F(0.2f), moving);
  const F luma = luma_of(history), contrast = abs(luma_of(current) - luma);
  const F slow = select(contrast > zero, saturated(F(0.01f) * luma / contrast), one);
  const F weight = weighted(min(max(share, slow), one), current, history, TemporalParts::Weighting::Luma);
  select(source.is_inside, history + (current - history) * weight, current).store(row.resolved + 4 * i);
}

}  // namespace taau

template <class Full, class One>
[[gnu::flatten]] void taau_resolve_row(const TaauFrame& frame, const TaauRow& row, std::size_t n) {
  const TemporalRow history_row{.column = row.column, .y = row.y, .width = frame.width, .height = frame.height};
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    taau::resolve_pixels<F>(frame, row, history_row, static_cast<std::ptrdiff_t>(i));
  });
}

template <class Full, class One>
constexpr TaauKernels taau_rows() {
  return {.resolve_row = &taau_resolve_row<Full, One>};
}

}  // namespace zoneplate::stages
