// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "zoneplate/antialias/temporal/drift_lanes.h"
#include "zoneplate/antialias/temporal/history_lanes.h"
#include "zoneplate/antialias/temporal/range_lanes.h"
#include "zoneplate/antialias/temporal/rectification_lanes.h"
#include "zoneplate/antialias/temporal/relight_lanes.h"
#include "zoneplate/antialias/temporal/surfaces_lanes.h"
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

/// Most of a row by wide vectors, which halve the number of instructions, then by narrower ones.
template <class Wide, class Full, class One>
[[gnu::flatten]] void resolve_temporal(const TemporalRow& row, const TemporalParts& parts, std::size_t n) {
  const auto resolve = [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    const F one(1.0f);
    const Followed<F> surface = followed_surface<F>(row, parts.dilation, i);
    const Source<F> source(surface, row, i);
    const Neighborhood<F> around(row, i);
    const Rgba<F> current = parts.has_kernel ? around.mean(parts.kernel) : around.middle;

    const F rest = one - saturated(speed_of(source) * F(1 / TemporalParts::fast));
    const F gamma = F(parts.moving_gamma) + F(parts.gamma - parts.moving_gamma) * (rest * rest);
    const F zero(0.0f);
    const auto nowhere = one > one;
    auto is_steady = nowhere;
    if (parts.trusts_rest) is_steady = source.is_inside & (F::load(row.restless + i) == zero);
    auto is_trusted = nowhere;
    F lasting(std::numeric_limits<float>::infinity());
    if (!none(is_steady)) {
      lasting = select(is_steady, F::load(row.lasting + i), lasting);
      is_trusted = is_steady & (lasting > F(TemporalParts::unlimited));
    }
    // Nine equal colours allow that colour alone, whatever the history is.
    const bool is_flat =
        parts.rectification != TemporalParts::Rectification::None && none(is_steady) && around.is_flat();
    Rgba<F> past = is_flat ? around.middle : history_of(row.history, row, parts, source, i);
    const PastPixels<F> nearest_past = nearest_pixels(row, source, i);
    const auto is_relit = is_steady & (F(TemporalParts::unlimited) > lasting);
    if (!none(is_relit)) {
      const Relit<F> now = relit(past, lasting, change_of_light(row, around, nearest_past, i));
      past = select(is_relit, now.history, past), lasting = select(is_relit, now.lasting, lasting);
    }
    Rgba<F> history = past;
    auto valid = is_trusted;
    if (!all(is_trusted)) {
      if (!is_flat) history = select(is_trusted, past, rectified(past, around, parts, gamma));
      valid = valid | is_valid(row, parts, surface, source, nearest_past, i);
    }
    Share<F> share = valid_share(row, parts, source, nearest_past, current, history, i);
    if (parts.trusts_rest) share = {max(share.weight, one / lasting), min(share.frames, lasting)};
    const F weight = weighted(share.weight, current, history, parts.weighting);
    Rgba<F> result = select(valid, history + (current - history) * weight, current);
    if (parts.keeps_current_alpha) result.c[3] = current.c[3];
    result.store(row.resolved, i);
    F frames = select(valid, share.frames, one);
    if (parts.trusts_rest)
      frames = select(F::load(row.restless + i) > one, min(frames, F(TemporalParts::left_frames)), frames);
    frames.store(row.frames_out + i);
  };
  std::size_t done = 0;
  if constexpr (Wide::lanes > Full::lanes)
    for (; done + Wide::lanes <= n; done += Wide::lanes) resolve.template operator()<Wide>(done);
  for_row<Full, One>(n - done, [&]<class F>(std::size_t i) { resolve.template operator()<F>(done + i); });
}

template <class Wide, class Full, class One>
constexpr TemporalKernels temporal() {
  return {.limit = &limit_colors<Full, One>,
          .encode = &encode_temporal<Full, One>,
          .decode = &decode_temporal<Full, One>,
          .take_surfaces = &take_surfaces<Full, One>,
          .compute_unrest = &compute_unrest<Full, One>,
          .detect_changes = &detect_changes<Full, One>,
          .find_drift = &find_drift<Full, One>,
          .resolve = &resolve_temporal<Wide, Full, One>,
          .sharpen = &sharpen_temporal<Full, One>};
}

}  // namespace zoneplate::stages
