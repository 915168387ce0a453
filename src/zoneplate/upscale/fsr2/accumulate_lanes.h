// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/fsr/accumulate_lanes.h"
#include "zoneplate/upscale/fsr2/accumulate.h"

/// Fsr2AccumulateKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

namespace fsr2 {

using namespace stages::fsr;

constexpr float epsilon = 1e-3f, max_half = 65504;

/// The four pixels of the last frame around a place.
///
/// A texture unit has fractions of 8 bits. Without them, history at rest would be a mean with 1e-5 of a neighbour, and
/// lumas of the same code would not be equal.
template <class F>
struct Nearest : Neighbours<F, 2> {
  using Neighbours<F, 2>::column, Neighbours<F, 2>::row, Neighbours<F, 2>::right, Neighbours<F, 2>::below;

  [[gnu::always_inline]] Nearest(const Fsr2AccumulateFrame& frame, F x, F y)
      : Neighbours<F, 2>(frame.width, frame.height, x, y, 0) {
    right = in_texture_unit(right), below = in_texture_unit(below);
  }
  [[gnu::always_inline]] static F in_texture_unit(F fraction) {
    return floor(fraction * F(256.0f) + F(0.5f)) * F(1.0f / 256);
  }
  /// The mean of four values, which are given by row.
  [[gnu::always_inline]] F mean(F a, F b, F c, F d) const {
    const F left = F(1.0f) - right, above = F(1.0f) - below;
    return (a * left + b * right) * above + (c * left + d * right) * below;
  }
  [[gnu::always_inline]] F mean(const float* plane) const {
    return mean(F::gather(plane, row[0] + column[0]), F::gather(plane, row[0] + column[1]),
                F::gather(plane, row[1] + column[0]), F::gather(plane, row[1] + column[1]));
  }
};

/// The history at a place of the last frame.
template <class F>
[[gnu::always_inline]] inline void sample_history(const Fsr2AccumulateFrame& frame, F u, F v, F (&out)[4]) {
  const F width = F(static_cast<float>(frame.width)), height = F(static_cast<float>(frame.height));
  const auto place = [](F at, F size) { return max(F(0.0f), min(size, at * size - F(0.5f))); };
  const Neighbours<F, 4> taps(frame.width, frame.height, place(u, width), place(v, height), 1);
  if (frame.has_lanczos) return sample_by_lanczos(frame.history, taps, epsilon, out);
  F corner[4][4];
  for (int k = 0; k < 4; ++k) taps.load(frame.history, 1 + k % 2, 1 + k / 2, corner[k]);
  for (int c = 0; c < 4; ++c)
    out[c] =
        mixed(mixed(corner[0][c], corner[1][c], taps.right), mixed(corner[2][c], corner[3][c], taps.right), taps.below);
}

/// A kernel of the square of a distance, at most 4, without negative lobes: (1 - x² / 4)⁴, nearly a Gaussian.
template <class F>
[[gnu::always_inline]] inline F bell_of_square(F x2) {
  const F a = F(1.0f) - F(0.25f) * min(x2, F(4.0f)), square = a * a;
  return square * square;
}

/// A lock of a thin feature: what is left of its life, and the shading when it began.
template <class F>
struct Lock {
  F life, luma;
};

/// The frame's samples around an output pixel: their mean by Lanczos' kernel, or by a bell, with its weight, their
/// range, and mean and deviation by a Gaussian.
template <class F>
struct Upsampled {
  Color<F> color, least, most, mean, deviation;
  F weight;
};

template <class F>
[[gnu::always_inline]] inline Upsampled<F> upsample(const Fsr2AccumulateRow& row, std::size_t i, F kernel, F curve,
                                                    bool has_lanczos) {
  using Int = typename F::Int;
  Upsampled<F> out;
  F dx[3], ex[3], dy[3], ey[3];
  for (int k = 0; k < 3; ++k) {
    dx[k] = F::load(row.dx[k] + i), dy[k] = F(row.dy[k]);
    ex[k] = exp(curve * (dx[k] * dx[k])), ey[k] = exp(curve * (dy[k] * dy[k]));
  }
  const F kernel2 = kernel * kernel;
  F weight = F(0.0f), box_weight = F(0.0f);
  Color<F> sum{{F(0.0f), F(0.0f), F(0.0f)}}, mean = sum, square = sum;
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      std::int32_t column[F::lanes];
      Int::load(row.columns[k] + i).store(column);
      F pixel[4];
      load_pixels<F>([&](int lane) { return row.prepared[r] + column[lane]; }, pixel);
      const F is_inside = F::load(row.is_column[k] + i) * F(row.is_row[r]);
      const F distance = kernel2 * (dx[k] * dx[k] + dy[r] * dy[r]), box = ex[k] * ey[r];
      const F w = is_inside * (has_lanczos ? lanczos_of_square(distance) : bell_of_square(distance));
      const bool is_first = k == 0 && r == 0;
      for (int c = 0; c < 3; ++c) {
        sum.c[c] = sum.c[c] + pixel[c] * w;
        out.least.c[c] = is_first ? pixel[c] : min(out.least.c[c], pixel[c]);
        out.most.c[c] = is_first ? pixel[c] : max(out.most.c[c], pixel[c]);
        const F weighted = pixel[c] * box;
        mean.c[c] = mean.c[c] + weighted, square.c[c] = square.c[c] + pixel[c] * weighted;
      }
      weight = weight + w, box_weight = box_weight + box;
    }
  const F box_scale = F(1.0f) / select(box_weight > F(epsilon), box_weight, F(1.0f));
  const auto has_weight = weight > F(epsilon);
  const F scale = F(1.0f) / select(has_weight, weight, F(1.0f));
  for (int c = 0; c < 3; ++c) {
    out.mean.c[c] = mean.c[c] * box_scale;
    out.deviation.c[c] = sqrt(abs(square.c[c] * box_scale - out.mean.c[c] * out.mean.c[c]));
    const F clamped = min(max(sum.c[c] * scale, out.least.c[c]), out.most.c[c]);
    out.color.c[c] = select(has_weight, clamped, sum.c[c]);
  }
  out.weight = where(has_weight, weight * F(1.0f / 12));
  return out;
}

/// 1 where the luma of the frame's neighbourhood alternates with that of one of the last four frames; `lumas` are
/// theirs, to which this frame's is added.
template <class F>
[[gnu::always_inline]] inline F luma_instability(F luma, F deviation, F (&lumas)[4]) {
  constexpr float step = 1.0f / 255;
  luma = luma / (F(1.0f) + max(F(0.0f), luma));
  luma = floor(luma * F(255.0f) + F(0.5f)) / F(255.0f);
  const F first = luma - lumas[0];
  F least = abs(first);
  for (int k = 1; k < 4; ++k) {
    const F other = luma - lumas[k];
    const auto is_same_side = ((first > F(0.0f)) & (other > F(0.0f))) | ((F(0.0f) > first) & (F(0.0f) > other));
    least = select(is_same_side, min(least, abs(other)), least);
  }
  const F share = saturated(deviation / F(0.1f)), cube = share * share * share;
  const auto is_unstable = (abs(first) >= F(step)) & (abs(first) > least) & (cube * cube > F(step));
  const auto has_all = abs(lumas[2]) > F(0.0f);
  for (int k = 3; k > 0; --k) lumas[k] = lumas[k - 1];
  lumas[0] = luma;
  return where(is_unstable & has_all, F(1.0f));
}

template <class F>
[[gnu::always_inline]] inline void accumulate_pixels(const Fsr2AccumulateFrame& frame, const Fsr2AccumulateRow& row,
                                                     std::size_t i) {
  using Int = typename F::Int;
  const F zero = F(0.0f), one = F(1.0f);
  const F width = F(static_cast<float>(frame.width)), height = F(static_cast<float>(frame.height));
  const F u = F::load(row.u + i), v = F(row.v);
  const Int motion_column = Int::load(row.motion_column + i);
  const F motion_x = F::gather(row.motion, motion_column), motion_y = F::gather(row.motion + 1, motion_column);
  const F px = motion_x * width, py = motion_y * height, velocity = sqrt(px * px + py * py);
  const F last_u = u + motion_x, last_v = v + motion_y;
  const auto exists = is_in_image(last_u, last_v);
  const auto is_old = exists & (F(frame.is_first ? 0.0f : 1.0f) > zero);

  const Int clip_column = Int::load(row.clip_column + i), mask_column = Int::load(row.mask_column + i);
  const F clip_right = F::load(row.clip_right + i), clip_below = F(row.clip_below);
  const float* const clips[2] = {row.clips[0] + 3, row.clips[1] + 3};
  const F clip = saturated(bilinear<F>(clips, clip_column, clip_column + Int(4), clip_right, clip_below));
  const F mask = bilinear<F>(row.masks, mask_column, mask_column + Int(1), clip_right, clip_below);

  // History, where there is one.
  Color<F> history{{zero, zero, zero}};
  F reactive = zero, was_moving = zero, lumas[4] = {zero, zero, zero, zero};
  Lock<F> lock{zero, zero};
  const bool has_history = !none(is_old);
  if (has_history) {
    F pixel[4];
    sample_history(frame, last_u, last_v, pixel);
    Color<F> exposed;
    for (int c = 0; c < 3; ++c) exposed.c[c] = min(max(pixel[c] * F(frame.exposure), zero), F(max_half));
    history = ycocg_of(exposed);
    reactive = where(is_old, saturated(abs(pixel[3])));
    was_moving = where(is_old & (zero > pixel[3]), one);
    const Nearest<F> nearest(frame, last_u * width - F(0.5f), last_v * height - F(0.5f));
    lock.life = where(is_old, nearest.mean(frame.lock_life)), lock.luma = where(is_old, nearest.mean(frame.lock_luma));
    F near[2][2][4];
    for (int r = 0; r < 2; ++r)
      for (int c = 0; c < 2; ++c) nearest.load(frame.lumas, c, r, near[r][c]);
    for (int k = 0; k < 4; ++k) lumas[k] = nearest.mean(near[0][0][k], near[0][1][k], near[1][0][k], near[1][1][k]);
  }

  // Locks follow the shading of the surroundings: a change ends them.
  const F log_luminance =
      bilinear<F>(row.luminances, Int::load(row.luminance_columns[0] + i), Int::load(row.luminance_columns[1] + i),
                  F::load(row.luminance_right + i), F(row.luminance_below));
  const F shading = exp(log_luminance * F(1.0f / 6)) * F(frame.exposure_root);
  lock.luma = select(lock.luma == zero, shading, lock.luma);
  const F change = one - smaller_over_greater(lock.luma, shading);
  const auto is_new_lock = is_old & (F::load(row.new_locks + i) > F(127.0f / 255));
  const auto is_young = one >= lock.life;
  const F young_luma = select(is_young, mixed(lock.luma, shading, F(0.5f)), lock.luma);
  const F kept_life = select(is_young, lock.life, where(F(0.1f) >= change, lock.life));
  const F renewed_life = select(lock.life == zero, one, F(2.0f));
  lock.luma = select(is_new_lock, shading, young_luma), lock.life = select(is_new_lock, renewed_life, kept_life);
  reactive = max(reactive, saturated((change - F(0.1f)) * F(10.0f)));
  lock.life = where(F(0.1f) > clip, lock.life * (one - reactive) * saturated(one - mask));
  const F lock_share =
      saturated(saturated(saturated(lock.life - one) * F(4.0f)) * saturated(smaller_over_greater(lock.luma, shading)));

  const F kernel_reactive = select(is_old, reactive, one);
  const F kernel_max = F(frame.kernel_max) * (one - kernel_reactive);
  const F kernel_min = max(one, (one + kernel_max) * F(0.3f));
  const F kernel = mixed(kernel_max, kernel_min, max(zero, max(F(0.25f) * clip, kernel_reactive)));
  const F curve = mixed(F(-2.0f), F(-3.0f), saturated(velocity / F(50.0f)));
  const Upsampled<F> samples = upsample<F>(row, i, kernel, curve, frame.has_lanczos);
  const F weight = samples.weight;

  const auto has_lumas = is_old & (F(0.1f) > max(max(clip, mask), change));
  for (F& luma : lumas) luma = where(has_lumas, luma);
  const F reactive_root = where(reactive > zero, pow(max(reactive, F(1e-20f)), F(1.0f / 6)));
  const F instability =
      luma_instability(samples.mean.c[0], samples.deviation.c[0], lumas) * (one - max(mask, reactive_root));

  // The weight of history: less in motion.
  F base = where(exists, (one - reactive) * (one - clip));
  base = min(base, mixed(base, weight * F(10.0f), max(was_moving, saturated(velocity * F(10.0f)))));
  base = min(base, mixed(base, weight, saturated(velocity / F(20.0f))));

  const Color<F> fresh = rgb_of(samples.color);
  Color<F> out = fresh;
  if (has_history) {
    if (frame.rectifies) {
      const F tightness = max(clip, max(mask, saturated(velocity / F(20.0f))));
      const F scale = mixed(F(frame.box_scale), one, tightness);
      auto is_outside = zero > one;
      Color<F> clamped;
      for (int c = 0; c < 3; ++c) {
        const F half = samples.deviation.c[c] * scale;
        const F low = max(samples.least.c[c], samples.mean.c[c] - half);
        const F high = min(samples.most.c[c], samples.mean.c[c] + half);
        is_outside = is_outside | (low > history.c[c]) | (history.c[c] > high);
        clamped.c[c] = min(max(history.c[c], low), high);
      }
      const F share = saturated(max(instability, lock_share));
      for (int c = 0; c < 3; ++c)
        history.c[c] = select(is_outside, mixed(clamped.c[c], history.c[c], share), history.c[c]);
      base = select(is_outside, mixed(min(base, F(0.1f)), base, share), base);
    }
    const F alpha = weight / max(F(epsilon), base + weight);
    const Color<F> from = tone_mapped(rgb_of(history)), to = tone_mapped(fresh);
    Color<F> blended;
    for (int c = 0; c < 3; ++c) blended.c[c] = mixed(from.c[c], to.c[c], alpha);
    blended = inverse_tone_mapped(blended, 1 / max_half);
    for (int c = 0; c < 3; ++c) out.c[c] = select(is_old, blended.c[c], fresh.c[c]);
  }

  const auto stays_inside = is_in_image(u - motion_x, v - motion_y);
  const F life = where(stays_inside, max(zero, lock.life - weight * F(frame.lock_decrease)));
  F factor = min(F(0.99f), reactive);
  factor = max(factor, mixed(factor, F(0.4f), saturated(velocity)));
  factor = max(factor * factor, clip * F(0.1f));
  factor = select(is_old, factor, one);
  factor = select(velocity * F(10.0f) >= one, -max(F(epsilon), factor), factor);

  const F result[4] = {out.c[0] / F(frame.exposure), out.c[1] / F(frame.exposure), out.c[2] / F(frame.exposure),
                       factor};
  F::store_fours(result, row.history + 4 * i), F::store_fours(lumas, row.lumas + 4 * i);
  life.store(row.lock_life + i), lock.luma.store(row.lock_luma + i);
}

}  // namespace fsr2

template <class Full, class One>
[[gnu::flatten]] void fsr2_accumulate_row(const Fsr2AccumulateFrame& frame, const Fsr2AccumulateRow& row,
                                          std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) { fsr2::accumulate_pixels<F>(frame, row, i); });
}

template <class Full, class One>
constexpr Fsr2AccumulateKernels fsr2_accumulate() {
  return {.accumulate_row = &fsr2_accumulate_row<Full, One>};
}

}  // namespace zoneplate::stages
