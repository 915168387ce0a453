// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/temporal/history_lanes.h"
#include "zoneplate/antialias/temporal/range_lanes.h"
#include "zoneplate/antialias/temporal/rectification_lanes.h"
#include "zoneplate/antialias/temporal/unrest_lanes.h"
#include "zoneplate/antialias/temporal/weight_lanes.h"

/// The kernels of antialias/temporal/resolve.h over the lane types of math/lanes.h.
namespace zoneplate::stages {

using antialias::TemporalKernels;

/// True where the history belongs to the followed surface, as far as the parts test it.
template <class F>
[[gnu::always_inline]] inline typename F::Bool is_valid(const TemporalRow& row, const TemporalParts& parts,
                                                        const Followed<F>& surface, const Source<F>& source,
                                                        const PastPixels<F>& nearest_past, std::ptrdiff_t i) {
  using Rejection = TemporalParts::Rejection;
  if (parts.rejection == Rejection::None) return source.is_inside;
  if (parts.rejection != Rejection::Edge) return source.is_inside & has_surface(row, parts, surface, nearest_past);
  // three.js: depthThreshold and edgeDepthDiff of depths in [0, 1].
  const F threshold(0.0005f), edge(0.001f);
  F nearest = F::load(row.nearness + i), farthest = nearest;
  for (const PixelOffset o : around_square) {
    const F other = F::load(row.nearness + i + o.x + o.y * row.stride);
    nearest = max(nearest, other), farthest = min(farthest, other);
  }
  const F before = nearest_past.value(row.past_nearness, 0, 0);
  return source.is_inside & ((nearest - farthest > edge) | (threshold >= before - surface.last_nearness));
}

/// True where all surfaces around move as one and the current luma is a plausible sample of those in the history.
///
/// Samples on an edge vary between both of its sides: one side of sixteen differs from the mean by 3.9 standard
/// deviations.
template <class F>
[[gnu::always_inline]] inline typename F::Bool is_steady(const TemporalRow& row, const Source<F>& source,
                                                         const Rgba<F>& current, const Rgba<F>& past, F square,
                                                         F frames, std::ptrdiff_t i) {
  const F zero(0.0f), most(4.0f), noise(0.02f), least_noise(0.002f), young(8.0f);
  const F mean = luma_of(past), difference = abs(luma_of(current) - mean);
  const F deviation = sqrt(max(square - mean * mean, zero));
  return source.is_inside & (F::load(row.restless + i) == zero) &
         ((young > frames) | (most * deviation + noise * mean + least_noise > difference));
}

template <class Full, class One>
[[gnu::flatten]] void resolve_temporal(const TemporalRow& row, const TemporalParts& parts, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    const F one(1.0f);
    const Followed<F> surface = followed_surface<F>(row, parts.dilation, i);
    const Source<F> source(surface, row, i);
    const Neighborhood<F> around(row, i);
    const Rgba<F> current = parts.has_kernel ? around.mean(parts.kernel) : around.middle;

    const F rest = one - saturated(speed_of(source) * F(1 / TemporalParts::fast));
    const F gamma = F(parts.moving_gamma) + F(parts.gamma - parts.moving_gamma) * (rest * rest);
    const Rgba<F> past = history_of(row, parts, source, i);
    Rgba<F> history = rectified(past, around, parts, gamma);
    const PastPixels<F> nearest_past = nearest_pixels(row, source, i);
    auto valid = is_valid(row, parts, surface, source, nearest_past, i);
    F square(0.0f);
    if (parts.trusts_rest) {
      square = nearest_past.value(row.squares, 0, 0);
      const F frames = nearest_past.value(row.frames, 0, 0);
      const auto is_trusted = is_steady(row, source, current, past, square, frames, i);
      history = select(is_trusted, past, history);
      valid = valid | is_trusted;
    }
    const Share<F> share = valid_share(row, parts, source, nearest_past, current, history, i);
    const F weight = weighted(share.weight, current, history, parts.weighting);
    Rgba<F> result = select(valid, history + (current - history) * weight, current);
    if (parts.trusts_rest) {
      const F luma = luma_of(current);
      select(valid, square + (luma * luma - square) * weight, luma * luma).store(row.squares_out + i);
    }
    if (parts.keeps_current_alpha) result.c[3] = current.c[3];
    result.store(row.resolved + 4 * i);
    F frames = select(valid, share.frames, one);
    if (parts.trusts_rest)
      frames = select(F::load(row.restless + i) > one, min(frames, F(TemporalParts::left_frames)), frames);
    frames.store(row.frames_out + i);
  });
}

template <class Full, class One>
constexpr TemporalKernels temporal() {
  return {.encode = &encode_temporal<Full, One>,
          .decode = &decode_temporal<Full, One>,
          .find_unrest = &find_unrest<Full, One>,
          .resolve = &resolve_temporal<Full, One>,
          .sharpen = &sharpen_temporal<Full, One>};
}

}  // namespace zoneplate::stages
