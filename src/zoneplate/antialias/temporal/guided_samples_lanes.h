// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/temporal/guided_samples.h"
#include "zoneplate/antialias/temporal/history_lanes.h"
#include "zoneplate/math/for_row.h"

/// GuidedKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

using antialias::GuidedKernels;
using antialias::GuidedRow;
using antialias::GuidedSample;
using antialias::GuidedSamples;

/// A bilinear sample of the colours around pixel i, as differences from the middle one.
template <class F>
[[gnu::always_inline]] inline Rgba<F> sampled(const GuidedSample& sample, const ColorPlanes<const float>& color,
                                              const Rgba<F>& middle, std::ptrdiff_t i) {
  Rgba<F> sum = Rgba<F>::all(F(0.0f));
  for (int k = 0; k < 4; ++k) {
    const int dx = sample.pixel[k] % 3 - 1, dy = sample.pixel[k] / 3 - 1;
    sum = sum + (Rgba<F>::load(color, i + dx + dy * color.stride()) - middle) * F(sample.weight[k]);
  }
  return middle + sum;
}

/// The squared distance of two colours in red, green and blue.
template <class F>
[[gnu::always_inline]] inline F squared_distance(const Rgba<F>& a, const Rgba<F>& b) {
  const Rgba<F> d = a - b;
  return (d.c[0] * d.c[0] + d.c[1] * d.c[1]) + d.c[2] * d.c[2];
}

template <class Full, class One>
[[gnu::flatten]] void resolve_guided(const GuidedRow& row, const GuidedSamples& samples, std::size_t n) {
  const TemporalRow place{.column = row.column, .y = row.y, .width = row.width, .height = row.height};
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    const F zero(0.0f);
    const Rgba<F> middle = Rgba<F>::load(row.color, i);
    const Rgba<F> centre = sampled<F>(samples.sample[0], row.color, middle, i);
    F nearest = zero;
    for (int k = 0; k < 9; ++k)
      nearest = max(nearest, F::load(row.nearness + i + k % 3 - 1 + (k / 3 - 1) * row.stride));
    const auto is_guided = nearest > zero;
    if (row.is_first || none(is_guided)) {
      centre.store(row.resolved, i);
      return;
    }

    const Source<F> source({{F::load(row.motion[0] + i), F::load(row.motion[1] + i)}, zero, zero, zero, zero}, place,
                           i);
    const Rgba<F> past = history_of(row.history, place, TemporalParts{}, source, i);
    const Rgba<F> guide = past + (centre - past) * F(1.0f / 16);
    Rgba<F> best = centre;
    F least = squared_distance(guide, centre);
    for (int k = 1; k < GuidedSamples::count; ++k) {
      const Rgba<F> sample = sampled<F>(samples.sample[k], row.color, middle, i);
      const F distance = squared_distance(guide, sample);
      const auto is_nearer = is_guided & (least > distance);
      best = select(is_nearer, sample, best), least = select(is_nearer, distance, least);
    }
    best.store(row.resolved, i);
  });
}

template <class Full, class One>
constexpr GuidedKernels guided_samples() {
  return {.resolve = &resolve_guided<Full, One>};
}

}  // namespace zoneplate::stages
