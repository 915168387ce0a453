// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/temporal/color_lanes.h"
#include "zoneplate/antialias/temporal/reprojection_lanes.h"

/// The weight of the current frame, over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// The weight, and the number of frames (or Bevy's confidence) that the next frame finds.
template <class F>
struct Share {
  F weight, frames;
};

template <class F>
[[gnu::always_inline]] inline F speed_of(const Source<F>& source) {
  return sqrt(source.motion[0] * source.motion[0] + source.motion[1] * source.motion[1]);
}

/// How far both coordinates of a motion are between pixels: 0 for whole pixels, 1 for halves.
///
/// Source    three.js, TRAANode.js: subpixelCorrection.
template <class F>
[[gnu::always_inline]] inline F subpixel_part(const Source<F>& source) {
  const F one(1.0f);
  const auto side = [&](F f) { return max(f, one - f); };
  return (one - side(source.fraction[0]) * side(source.fraction[1])) * F(1 / 0.75f);
}

/// The weight of the current frame where the history is valid.
template <class F>
[[gnu::always_inline]] inline Share<F> valid_share(const TemporalRow& row, const TemporalParts& parts,
                                                   const Source<F>& source, const PastPixels<F>& nearest_past,
                                                   const Rgba<F>& current, const Rgba<F>& history, std::ptrdiff_t i) {
  using Blend = TemporalParts::Blend;
  const F zero(0.0f), one(1.0f), least(parts.min_weight);
  switch (parts.blend) {
    case Blend::Fixed:
      return {least, one};
    case Blend::Count: {
      const F frames = min(nearest_past.value(row.frames, 0, 0) + one, F(TemporalParts::unlimited));
      return {max(one / frames, least), frames};
    }
    case Blend::Contrast: {
      // INSIDE keeps 0.88 to 0.97 of the history: min_weight is 1 - 0.97.
      const F a = luminance_of(current), b = luminance_of(history);
      const F likeness = one - abs(a - b) / max(a, max(b, F(0.2f)));
      return {F(0.12f) + (least - F(0.12f)) * (likeness * likeness), one};
    }
    case Blend::Velocity:
      return {saturated(least + F(0.25f) * subpixel_part(source) +
                        saturated(speed_of(source) * F(1 / TemporalParts::fast))),
              one};
    case Blend::Confidence: {
      // Bevy reads the confidence of this pixel, not that of the reprojected one.
      const F before = F::load(row.frames + (std::ptrdiff_t{row.y} * row.width + i));
      const F limit(0.01f);
      const auto is_still = (limit > abs(source.motion[0])) & (limit > abs(source.motion[1]));
      const F frames = select(is_still, before + F(10.0f), one);
      return {min(max(one / frames, least), F(0.1f)), frames};
    }
    case Blend::Motion: {
      const F moving = saturated(speed_of(source) * F(1.0f / 40));
      const F weight = least + (F(0.2f) - least) * moving;
      const F a = luma_of(current), b = luma_of(history), contrast = abs(a - b);
      const F slow = select(contrast > zero, saturated(F(0.01f) * b / contrast), one);
      return {max(weight, slow), one};
    }
  }
  return {one, one};
}

template <class F>
[[gnu::always_inline]] inline F factor_of(const Rgba<F>& c, TemporalParts::Weighting weighting) {
  const F one(1.0f);
  if (weighting == TemporalParts::Weighting::Luma) return one / (one + luma_of(c));
  return one / (one + luminance_of(c) / (one + max3(c)));
}

/// The weight of the current colour among both, where each colour has its own factor.
template <class F>
[[gnu::always_inline]] inline F weighted(F weight, const Rgba<F>& current, const Rgba<F>& history,
                                         TemporalParts::Weighting weighting) {
  if (weighting == TemporalParts::Weighting::None) return weight;
  const F a = weight * factor_of(current, weighting), b = (F(1.0f) - weight) * factor_of(history, weighting);
  return a / max(a + b, F(1e-5f));
}

}  // namespace zoneplate::stages
