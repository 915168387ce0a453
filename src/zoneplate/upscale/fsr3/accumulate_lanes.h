// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/fsr3/accumulate.h"
#include "zoneplate/upscale/fsr3/fsr3_lanes.h"

/// Fsr3AccumulateKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

namespace fsr3 {

/// The colour and the lock at a place of the last frame, whose outermost pixels are not read.
template <class F>
[[gnu::always_inline]] inline void sample_history(const Fsr3AccumulateFrame& frame, F u, F v, F (&out)[4]) {
  const F px = u * F(static_cast<float>(frame.width)) - F(0.5f);
  const F py = v * F(static_cast<float>(frame.height)) - F(0.5f);
  const auto inside = [](F at, int size) { return max(F(0.0f), min(F(static_cast<float>(size - 1)), at)); };
  Neighbours<F, 4> taps(frame.width, frame.height, inside(px, frame.width), inside(py, frame.height), 1, 1);
  taps.right = px - floor(px), taps.below = py - floor(py);  // of the place itself, also beyond the outermost centres
  sample_by_lanczos(frame.history, taps, epsilon, out);
}

/// The frame's samples around an output pixel: their sum by Lanczos' kernel with its weight, their range, and mean and
/// deviation by a Gaussian.
template <class F>
struct Samples {
  Color<F> sum, least, most, mean, deviation;
  F weight;
};

template <class F>
[[gnu::always_inline]] inline Samples<F> gather_samples(const Fsr3AccumulateFrame& frame, const Fsr3AccumulateRow& row,
                                                        std::size_t i, F kernel, typename F::Bool is_tone_mapped) {
  using Int = typename F::Int;
  Samples<F> out;
  const Int offset = where(is_tone_mapped, Int(frame.tone_mapped));
  F dx[3];
  std::int32_t columns[3][F::lanes];
  for (int k = 0; k < 3; ++k) {
    dx[k] = F::load(row.dx[k] + i);
    (Int::load(row.columns[k] + i) + offset).store(columns[k]);
  }
  const F kernel2 = kernel * kernel, zero = F(0.0f);
  F box_weight = zero;
  out.weight = zero;
  Color<F> square{{zero, zero, zero}};
  out.sum = out.mean = square;
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      F pixel[4];
      load_pixels<F>([&](int lane) { return row.prepared[r] + columns[k][lane]; }, pixel);
      const F is_inside = F::load(row.is_column[k] + i) * F(row.is_row[r]), dy = F(row.dy[r]);
      const F w = is_inside * lanczos_of_square(kernel2 * (dx[k] * dx[k] + dy * dy));
      const F box = F::load(row.box_x[k] + i) * F(row.box_y[r]);
      const bool is_first = k == 0 && r == 0;
      for (int c = 0; c < 3; ++c) {
        out.sum.c[c] = out.sum.c[c] + pixel[c] * w;
        out.least.c[c] = is_first ? pixel[c] : min(out.least.c[c], pixel[c]);
        out.most.c[c] = is_first ? pixel[c] : max(out.most.c[c], pixel[c]);
        const F weighted = pixel[c] * box;
        out.mean.c[c] = out.mean.c[c] + weighted, square.c[c] = square.c[c] + pixel[c] * weighted;
      }
      out.weight = out.weight + w, box_weight = box_weight + box;
    }
  const F scale = F(1.0f) / box_weight;  // the nearest sample alone has a positive weight
  for (int c = 0; c < 3; ++c) {
    out.mean.c[c] = out.mean.c[c] * scale;
    out.deviation.c[c] = sqrt(abs(square.c[c] * scale - out.mean.c[c] * out.mean.c[c]));
  }
  return out;
}

/// History that lies outside of an ellipsoid around the mean of the samples is moved to its surface, but for `share`.
template <class F>
[[gnu::always_inline]] inline Color<F> rectified(const Color<F>& history, const Samples<F>& samples, F scale, F share) {
  const F axes[3] = {samples.deviation.c[0] * F(1.7f) * scale, samples.deviation.c[1] * scale,
                     samples.deviation.c[2] * scale};
  F away[3], square = F(0.0f);
  for (int c = 0; c < 3; ++c) {
    away[c] = (history.c[c] - samples.mean.c[c]) / max(axes[c], F(1.193e-7f));
    square = square + away[c] * away[c];
  }
  const F length = sqrt(square);
  const auto is_outside = length > F(1.0f);
  const F shrink = F(1.0f) / select(is_outside, length, F(1.0f));
  Color<F> out;
  for (int c = 0; c < 3; ++c) {
    const F clamped = away[c] * shrink * axes[c] + samples.mean.c[c];
    out.c[c] = select(is_outside, mixed(clamped, history.c[c], share), history.c[c]);
  }
  return out;
}

template <class F>
[[gnu::always_inline]] inline void accumulate_pixels(const Fsr3AccumulateFrame& frame, const Fsr3AccumulateRow& row,
                                                     std::size_t i) {
  using Int = typename F::Int;
  const F zero = F(0.0f), one = F(1.0f);
  const F u = F::load(row.u + i), v = F(row.v);
  const Int motion_column = Int::load(row.motion_column + i);
  const F motion_x = F::gather(row.motion, motion_column), motion_y = F::gather(row.motion + 1, motion_column);
  const F velocity = velocity_of(motion_x, motion_y);
  const F last_u = u + motion_x, last_v = v + motion_y;
  const auto is_old = is_in_image(last_u, last_v) & (F(frame.is_first ? 0.0f : 1.0f) > zero);

  F masks[4];
  pixels_between(row.masks, i, masks);
  const F reactive = masks[0], hidden = masks[1], change = masks[2];
  const F kept = where(masks[3] * F(100.0f) >= F(1.5f), masks[3]);
  const auto is_new = kept == zero;

  Color<F> history{{zero, zero, zero}};
  F lock = zero;
  if (!none(is_old)) {
    F pixel[4];
    sample_history(frame, last_u, last_v, pixel);
    Color<F> exposed;
    for (int c = 0; c < 3; ++c) exposed.c[c] = where(is_old, pixel[c] * F(frame.exposure));
    history = ycocg_of(exposed);
    lock = where(is_old, pixel[3]);
  }

  // Locks lie in [0, 2]; what exceeds 1 protects history. They decay, and end where the image changes.
  const F end = max(change, max(reactive, hidden));
  lock = max(zero, lock - end * F(2.0f));
  const F lock_share = saturated(lock - one);
  lock = min(lock + F::load(row.new_locks + i) * (one - reactive), F(2.0f));
  lock = max(zero, lock - F(frame.lock_decrease) * (one - end));
  lock = where(is_in_image(u - motion_x, v - motion_y), lock);

  // History counts less in motion, and the kernel is wider where there is less of it.
  F base = min(kept, mixed(kept, F(0.15f), saturated(velocity * F(frame.velocity_factor) * F(2.0f))));
  const F kernel_max = F(frame.kernel_max), kernel_min = max(one, (one + kernel_max) * F(0.3f));
  const F narrowness = min(one - hidden * F(0.5f), min(one - change, saturated(base * F(5.0f))));
  const Samples<F> samples = gather_samples<F>(frame, row, i, mixed(kernel_min, kernel_max, narrowness), is_new);

  // The frame's colour; without history the Gaussian mean of the tone-mapped samples.
  const auto has_weight = samples.weight > F(epsilon);
  const F sum_scale = one / select(has_weight, samples.weight, one);
  Color<F> fresh;
  for (int c = 0; c < 3; ++c) {
    const F clamped = min(max(samples.sum.c[c] * sum_scale, samples.least.c[c]), samples.most.c[c]);
    fresh.c[c] = select(has_weight, clamped, samples.sum.c[c]);
  }
  const Color<F> first = inverse_tone_mapped(rgb_of(samples.mean), epsilon), upsampled = rgb_of(fresh);
  for (int c = 0; c < 3; ++c) fresh.c[c] = select(is_new, first.c[c], upsampled.c[c]);
  constexpr float mean_weight = 0.74f / 16;  // of the sum of a frame's weights
  const F weight = where(has_weight, samples.weight * F(mean_weight));
  base = where(base > F(epsilon), base);

  if (frame.rectifies) {
    const F instability = between<F>(row.instability, i), depth = between<F>(row.farthest_depth, i);
    const F is_near = saturated(F(0.75f) - depth / F(20.0f));
    const F tightness = max(max(max(saturated(velocity / F(20.0f)), is_near), max(one - kept, sqrt(reactive))), change);
    const F share = saturated(max(instability, lock_share) * kept * (one - hidden));
    history = rectified(history, samples, mixed(F(3.0f), one, tightness), share);
  }
  const F alpha = saturated(weight / max(F(epsilon), base + weight));
  const Color<F> from = tone_mapped(rgb_of(history)), to = tone_mapped(fresh);
  Color<F> blended;
  for (int c = 0; c < 3; ++c) blended.c[c] = select(is_new, to.c[c], mixed(from.c[c], to.c[c], alpha));
  blended = inverse_tone_mapped(blended, epsilon);

  F result[4] = {zero, zero, zero, lock};
  for (int c = 0; c < 3; ++c) result[c] = max(blended.c[c] / F(frame.exposure), zero);
  F::store_fours(result, row.history + 4 * i);
}

}  // namespace fsr3

template <class Full, class One>
[[gnu::flatten]] void fsr3_accumulate_row(const Fsr3AccumulateFrame& frame, const Fsr3AccumulateRow& row,
                                          std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) { fsr3::accumulate_pixels<F>(frame, row, i); });
}

template <class Full, class One>
constexpr Fsr3AccumulateKernels fsr3_accumulate() {
  return {.accumulate_row = &fsr3_accumulate_row<Full, One>};
}

}  // namespace zoneplate::stages
