// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/temporal/history_lanes.h"
#include "zoneplate/antialias/temporal/range_lanes.h"
#include "zoneplate/antialias/temporal/rectification_lanes.h"
#include "zoneplate/antialias/temporal/surfaces_lanes.h"
#include "zoneplate/antialias/temporal/unrest_lanes.h"
#include "zoneplate/antialias/temporal/weight_lanes.h"

/// The kernels of antialias/temporal/resolve.h over the lane types of math/lanes.h.
namespace zoneplate::stages {

using antialias::ChangeRow;
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

/// The statistics of luma in a history.
///
/// Samples on an edge vary between both of its sides: one side of sixteen differs from the mean by 3.9 standard
/// deviations.
template <class F>
struct History {
  F mean, variance;
  /// The greatest difference from the mean that a sample of the same light has.
  [[gnu::always_inline]] F spread() const { return F(4.0f) * sqrt(variance) + F(0.02f) * mean + F(0.002f); }
};

template <class Full, class One>
[[gnu::flatten]] bool find_changes(const ChangeRow& row, float* changes, std::size_t n) {
  bool is_any = false;
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    const F zero(0.0f), one(1.0f);
    const auto is_known =
        (F::load(row.restless + i) == zero) & (F::load(row.frames + i) >= F(TemporalParts::known_frames));
    if (none(is_known)) {
      zero.store(changes + i);
      return;
    }
    const F luma = luma_of(encoded_color<F>(row.linear + 4 * i, row.is_compressed)),
            mean = luma_of(Rgba<F>::load(row.history, i));
    const History<F> past{mean, max(F::load(row.squares + i) - mean * mean, zero)};
    const F difference = luma - mean;
    const F sign = select(difference > zero, one, -one);
    const auto is_changed = is_known & (abs(difference) > past.spread());
    is_any = is_any || !none(is_changed);
    where(is_changed, sign).store(changes + i);
  });
  return is_any;
}

/// The sum of 3 x 3 values around value i.
template <class F>
[[gnu::always_inline]] inline F sum_around(const float* values, std::ptrdiff_t stride, std::ptrdiff_t i) {
  F sum(0.0f);
  for (int k = 0; k < 9; ++k) sum = sum + F::load(values + i + k % 3 - 1 + (k / 3 - 1) * stride);
  return sum;
}

template <class Full, class One>
[[gnu::flatten]] bool find_relit(const float* changes, std::ptrdiff_t stride, float* relit, std::size_t n) {
  bool is_any = false;
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const F sum = sum_around<F>(changes, stride, static_cast<std::ptrdiff_t>(at));
    const auto is_relit = abs(sum) > F(6.5f);
    is_any = is_any || !none(is_relit);
    where(is_relit, F(1.0f)).store(relit + at);
  });
  return is_any;
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
    // Nine equal colours allow that colour alone, whatever the history is.
    const bool is_flat =
        parts.rectification != TemporalParts::Rectification::None && none(is_steady) && around.is_flat();
    const Rgba<F> past = is_flat ? around.middle : history_of(row.history, row, parts, source, i);
    const PastPixels<F> nearest_past = nearest_pixels(row, source, i);
    Rgba<F> history = past;
    F square(0.0f);
    auto relit = nowhere, is_trusted = nowhere;
    if (parts.trusts_rest) square = nearest_past.value(row.squares, 0, 0);
    if (!none(is_steady)) {
      const F frames = nearest_past.value(row.frames, 0, 0);
      const F luma = luma_of(current), mean = luma_of(past);
      const History<F> earlier{mean, max(square - mean * mean, zero)};
      relit = is_steady & (F::load(row.relit + i) > F(0.5f));
      const auto is_plausible = ((F(8.0f) > frames) | (earlier.spread() > abs(luma - mean)));
      is_trusted = is_steady & is_plausible & (F(0.5f) > where(relit, one));
    }
    auto valid = is_trusted;
    if (!all(is_trusted)) {
      if (!is_flat) history = select(is_trusted, past, rectified(past, around, parts, gamma));
      valid = valid | is_valid(row, parts, surface, source, nearest_past, i);
      // The squares of another light would let any later change pass as spread.
      const F allowed = luma_of(history);
      square = select(relit, allowed * allowed, square);
    }
    Share<F> share = valid_share(row, parts, source, nearest_past, current, history, i);
    if (parts.trusts_rest) {
      share.weight = select(relit, max(share.weight, F(1 / TemporalParts::left_frames)), share.weight);
      share.frames = select(relit, min(share.frames, F(TemporalParts::left_frames)), share.frames);
    }
    const F weight = weighted(share.weight, current, history, parts.weighting);
    Rgba<F> result = select(valid, history + (current - history) * weight, current);
    if (parts.trusts_rest) {
      const F luma = luma_of(current);
      select(valid, square + (luma * luma - square) * weight, luma * luma).store(row.squares_out + i);
    }
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
          .find_unrest = &find_unrest<Full, One>,
          .find_changes = &find_changes<Full, One>,
          .find_relit = &find_relit<Full, One>,
          .resolve = &resolve_temporal<Wide, Full, One>,
          .sharpen = &sharpen_temporal<Full, One>};
}

}  // namespace zoneplate::stages
