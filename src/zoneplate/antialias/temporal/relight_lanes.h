// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/antialias/temporal/past_pixels_lanes.h"
#include "zoneplate/antialias/temporal/rectification_lanes.h"
#include "zoneplate/antialias/temporal/resolve.h"

/// The history under the light of this frame, over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// The ratio of this frame's colours to those of the history, by channel: of weighted sums over 3 × 3 pixels.
///
/// A pixel weighs as the inverse of the variance of its samples, since within surfaces both differ by the light alone,
/// and at edges by the jitter too. Where they are equal, the ratio is 1.
template <class F>
[[gnu::always_inline]] inline Rgba<F> change_of_light(const antialias::TemporalRow& row, const Neighborhood<F>& around,
                                                      const PastPixels<F>& past, std::ptrdiff_t i) {
  // A code of a dark colour, and the variance of 0.6 percent of a bright one.
  const F least(0.0003f), min_noise(1e-6f), part_of_square(0.00004f), one(1.0f);
  return past.with_colors(row.history, [&](const auto& color) {
    Rgba<F> now = Rgba<F>::all(F(0.0f)), then = now;
    for (int k = 0; k < 9; ++k) {
      const int dx = k % 3 - 1, dy = k / 3 - 1;
      const Rgba<F> old = color(dx, dy);
      const F luminance = luminance_of(old), noise = F::load(row.noise + i + dx + dy * row.stride);
      const F weight = one / (noise + min_noise + part_of_square * (luminance * luminance));
      now = now + (around.color(k) + Rgba<F>::all(least)) * weight;
      then = then + (old + Rgba<F>::all(least)) * weight;
    }
    return Rgba<F>{{now.c[0] / then.c[0], now.c[1] / then.c[1], now.c[2] / then.c[2], now.c[3] / then.c[3]}};
  });
}

/// The history of surfaces at rest, scaled by the change of the light on them; and the number of frames that it counts
/// as: fewer where the light has changed by more than twice, so that a switched light leaves nothing.
template <class F>
struct Relit {
  Rgba<F> history;
  F lasting;
};

template <class F>
[[gnu::always_inline]] inline Relit<F> relit(const Rgba<F>& history, F lasting, const Rgba<F>& change) {
  using antialias::TemporalParts;
  const F low(1 / TemporalParts::max_change), high(TemporalParts::max_change);
  const Rgba<F> bounded = min(max(change, Rgba<F>::all(low)), Rgba<F>::all(high));
  return {history * bounded, select(bounded == change, lasting, F(TemporalParts::left_frames))};
}

}  // namespace zoneplate::stages
