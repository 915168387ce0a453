// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>

#include "zoneplate/antialias/temporal/range_lanes.h"
#include "zoneplate/antialias/temporal/resolve.h"
#include "zoneplate/math/for_row.h"

/// Where the light on surfaces at rest changes, at once or slowly, over a lane type of math/lanes.h.
///
/// Luminance is Rec.709's, in which no fade between two saturated colours is constant.
namespace zoneplate::stages {

using antialias::ChangeRow;
using antialias::DriftRow;
using antialias::TemporalParts;

/// Noise is the variance of luminance by the jitter alone: a sixth of the squared second differences of successive
/// frames, which a steady drift does not enter, and those that nine neighbours have in common, as under a light that
/// flickers, hardly.
///
/// The share of a frame in the noise, and that in the fast mean, which is of half the frames of the history at most.
constexpr float noise_share = 1 / 32.0f;
template <class F>
[[gnu::always_inline]] inline F fast_share(F frames) {
  return min(max(F(2.0f) / frames, F(1 / 8.0f)), F(1.0f));
}

template <class Full, class One>
[[gnu::flatten]] void detect_changes(const ChangeRow& row, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    const F zero(0.0f), one(1.0f);
    const F now = luminance_of(encoded_color<F>(row.linear + 4 * i, row.is_compressed)),
            step = now - F::load(row.last + i), bend = step - F::load(row.step + i);
    const F frames = F::load(row.frames + i), noise = F::load(row.noise + i), before = F::load(row.fast + i);
    const auto rests = F::load(row.restless + i) == zero;
    const F fast = select(rests, before + (now - before) * fast_share(frames), now);
    now.store(row.last + i), step.store(row.step + i), fast.store(row.fast + i);
    bend.store(row.bend + i);
    if (none(rests)) {
      zero.store(row.changes + i), zero.store(row.drift + i);
      return;
    }
    const F mean = luminance_of(Rgba<F>::load(row.history, i)), difference = now - mean;
    // Samples on an edge vary between both of its sides: one side of sixteen differs from the mean by 3.9 standard
    // deviations.
    const F spread = F(4.0f) * sqrt(noise) + F(0.02f) * mean + F(0.002f);
    const auto is_changed = rests & (frames >= F(TemporalParts::known_frames)) & (abs(difference) > spread);
    where(is_changed, select(difference > zero, one, -one)).store(row.changes + i);
    where(rests, fast - mean).store(row.drift + i);
  });
}

/// The sum of 3 x 3 values around value i.
template <class F>
[[gnu::always_inline]] inline F sum_around(const float* values, std::ptrdiff_t stride, std::ptrdiff_t i) {
  F sum(0.0f);
  for (int k = 0; k < 9; ++k) sum = sum + F::load(values + i + k % 3 - 1 + (k / 3 - 1) * stride);
  return sum;
}

/// The greatest minus the least of 3 x 3 values around value i.
template <class F>
[[gnu::always_inline]] inline F range_around(const float* values, std::ptrdiff_t stride, std::ptrdiff_t i) {
  F low = F::load(values + i), high = low;
  for (int k = 0; k < 9; ++k) {
    const F value = F::load(values + i + k % 3 - 1 + (k / 3 - 1) * stride);
    low = min(low, value), high = max(high, value);
  }
  return high - low;
}

/// How far a value is from value i, and beyond the mean ± the standard deviation of 3 x 3 values around it.
template <class F>
[[gnu::always_inline]] inline F excess(F value, const float* values, std::ptrdiff_t stride, std::ptrdiff_t i) {
  const F middle = F::load(values + i), ninth(1.0f / 9);
  F sum(0.0f), squares(0.0f);
  for (int k = 0; k < 9; ++k) {
    const F d = F::load(values + i + k % 3 - 1 + (k / 3 - 1) * stride) - middle;
    sum = sum + d, squares = squares + d * d;
  }
  const F mean = sum * ninth, deviation = sqrt(max(squares * ninth - mean * mean, F(0.0f)));
  return min(abs(value - middle), abs(value - middle - mean) - deviation);
}

template <class Full, class One>
[[gnu::flatten]] bool find_drift(const DriftRow& row, float* lasting, float* relit, float* next_noise, std::size_t n) {
  // Half a percent, or a code of a dark colour, is not seen.
  constexpr float least = 0.0003f, min_part = 0.005f;
  constexpr float errors = 4.0f, part_of_range = 0.1f;
  bool is_any = false;
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    const F one(1.0f), two(2.0f), nine(9.0f), trusted(std::numeric_limits<float>::infinity());
    const auto is_relit = abs(sum_around<F>(row.changes, row.stride, i)) > F(6.5f);
    is_any = is_any || !none(is_relit);
    where(is_relit, one).store(relit + i);

    const F fast = F::load(row.fast + i), mean = fast - F::load(row.drift + i);
    const F unseen = F(least) + F(min_part) * fast;
    const F beyond = excess(mean, row.last, row.stride, i), drift = abs(sum_around<F>(row.drift, row.stride, i));
    const F noise = F::load(row.noise + i), frames = F::load(row.frames + i);
    F out = trusted;
    if (!none((beyond > unseen) | (drift > nine * unseen))) {
      // By a part of their range the samples of a smooth gradient differ. The noise of few frames is not known.
      const F range = range_around<F>(row.fast, row.stride, i);
      const auto is_new = F(4.0f) > frames;
      const auto is_beyond = beyond > unseen + max(F(4.0f) * sqrt(noise), where(is_new, range));
      // The variances of both means: of the fast one, and of `frames` frames.
      const F share = fast_share(frames);
      const F variance = sum_around<F>(row.noise, row.stride, i) * (share / (two - share) + one / frames);
      const F allowed = F(errors) * sqrt(variance) + nine * select(is_new, F(0.7f), F(part_of_range)) * range;
      out = select(is_beyond, F(TemporalParts::unlimited), out);
      out = select(drift > nine * unseen + allowed, F(TemporalParts::relit_frames), out);
    }
    // A change of light bends nine luminances together, the jitter each by itself.
    const F bend = F::load(row.bend + i), own = bend - sum_around<F>(row.bend, row.stride, i) * F(1 / 9.0f);
    const F square = min(bend * bend, F(8.0f) * own * own) * F(1 / 6.0f);
    (noise + (square - noise) * max(one / frames, F(noise_share))).store(next_noise + i);
    out.store(lasting + i);
  });
  return is_any;
}

}  // namespace zoneplate::stages
