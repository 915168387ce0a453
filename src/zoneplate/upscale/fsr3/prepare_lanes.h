// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/fsr3/fsr3_lanes.h"
#include "zoneplate/upscale/fsr3/prepare.h"

/// Fsr3PrepareKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

namespace fsr3 {

/// The motion of n pixels from pixel i of row y on.
template <class F>
struct Motion {
  F x, y, velocity;  ///< velocity: in pixels of an output of 3840 × 2160

  [[gnu::always_inline]] Motion(const Fsr3PrepareFrame& frame, std::size_t pixel) {
    float mx[F::lanes], my[F::lanes];
    for (std::size_t k = 0; k < std::size_t{F::lanes}; ++k)
      mx[k] = frame.motion[2 * (pixel + k)], my[k] = frame.motion[2 * (pixel + k) + 1];
    x = F::load(mx), y = F::load(my), velocity = velocity_of(x, y);
  }
};

/// The lumas of a pixel and of its four neighbours, exposed, in ascending order.
template <class F>
[[gnu::always_inline]] inline void sorted_lumas(const Fsr3PrepareFrame& frame, const float* luma, F u, F v,
                                                F (&out)[5]) {
  using Int = typename F::Int;
  static constexpr int offsets[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  const F width = F(static_cast<float>(frame.width)), height = F(static_cast<float>(frame.height));
  // At most two pixels beyond the image, which its edge pixels continue.
  const F px = min(max(floor(u * width), F(-2.0f)), width + F(1.0f));
  const F py = min(max(floor(v * height), F(-2.0f)), height + F(1.0f));
  const Int x = truncate(px), y = truncate(py);
  for (int k = 0; k < 5; ++k) {
    const Int column = min(max(x + Int(offsets[k][0]), Int(0)), Int(frame.width - 1));
    const Int row = min(max(y + Int(offsets[k][1]), Int(0)), Int(frame.height - 1));
    out[k] = max(F::gather(luma, row * Int(frame.width) + column) * F(frame.exposure), F(epsilon));
  }
  static constexpr int pairs[9][2] = {{0, 1}, {3, 4}, {2, 4}, {2, 3}, {1, 4}, {0, 3}, {0, 2}, {1, 3}, {1, 2}};
  for (const auto& [a, b] : pairs) {
    const F low = min(out[a], out[b]);
    out[b] = max(out[a], out[b]), out[a] = low;
  }
}

/// The least relative difference that five steps of a merge of two ascending lists meet, with its sign; 0 if they meet
/// two equal values. A step leaves the smaller value behind, and in `last` also one that the next of `now` exceeds.
template <class F>
[[gnu::always_inline]] inline F min_difference(F (&now)[5], F (&last)[5]) {
  F least = F(max_half);
  auto is_equal = F(0.0f) > F(1.0f);
  for (int step = 0; step < 5; ++step) {
    const F difference = now[0] - last[0];
    is_equal = is_equal | (F(epsilon) >= abs(difference));
    const F relative = F(1.0f) - min(now[0], last[0]) / max(now[0], last[0]);
    least = select(abs(least) > relative, select(difference > F(0.0f), relative, -relative), least);
    const auto is_less = now[0] < last[0];
    for (int k = 0; k < 4 - step; ++k) now[k] = select(is_less, now[k + 1], now[k]);
    const auto exceeds = now[0] >= last[0];
    for (int k = 0; k < 4 - step; ++k) last[k] = select(exceeds, last[k + 1], last[k]);
  }
  return select(is_equal, F(0.0f), least);
}

template <class F>
[[gnu::always_inline]] inline void differences(const Fsr3PrepareFrame& frame, std::int32_t y, std::size_t i,
                                               float* out) {
  const F width = F(static_cast<float>(frame.width)), height = F(static_cast<float>(frame.height));
  const F u = F::load(frame.u + i), v = F(static_cast<float>(y) + 0.5f) / height;
  const Motion<F> motion(frame, static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + i);
  const F last_u = u + F(frame.last_jitter_x) / width + motion.x;
  const F last_v = v + F(frame.last_jitter_y) / height + motion.y;
  F now[5], last[5];
  sorted_lumas(frame, frame.luma, u + F(frame.jitter_x) / width, v + F(frame.jitter_y) / height, now);
  sorted_lumas(frame, frame.last_luma, last_u, last_v, last);
  where(is_in_image(last_u, last_v), min_difference(now, last)).store(out + i);
}

/// The share of a pixel that was hidden in the last frame.
template <class F>
[[gnu::always_inline]] inline F disocclusion(const Fsr3PrepareFrame& frame, F u, F v, const Motion<F>& motion,
                                             F depth) {
  const F width = F(static_cast<float>(frame.width)), height = F(static_cast<float>(frame.height));
  const auto is_motion = motion.velocity > min_velocity(depth);
  const auto place = [](F at, F size) { return min(max(at * size - F(0.5f), F(-2.0f)), size + F(1.0f)); };
  const Neighbours<F, 2> taps(frame.width, frame.height, place(u + where(is_motion, motion.x), width),
                              place(v + where(is_motion, motion.y), height), 0);
  F seen = F(0.0f), sum = F(0.0f);
  auto is_seen = F(0.0f) > F(1.0f);
  for (int k = 0; k < 4; ++k) {
    const F before = F::gather(frame.previous_depth, taps.row[k / 2] + taps.column[k % 2]);
    const F behind = depth - before;
    const F x = k % 2 ? taps.right : F(1.0f) - taps.right, y = k / 2 ? taps.below : F(1.0f) - taps.below;
    const F weight = where(x * y > F(min_weight), x * y);
    const auto is_behind = behind > F(std::numeric_limits<float>::min());
    is_seen = is_seen | ((weight > F(0.0f)) & (F(std::numeric_limits<float>::min()) >= behind));
    const F share = F(frame.separation) * max(depth, before) / select(is_behind, behind, F(1.0f));
    seen = seen + saturated(share) * weight, sum = sum + weight;
  }
  return select(is_seen, F(0.0f), saturated(F(1.0f) - seen / sum));
}

/// How much slower the surface at the place is to which the motion leads.
template <class F>
[[gnu::always_inline]] inline F motion_divergence(const Fsr3PrepareFrame& frame, F u, F v, const Motion<F>& motion,
                                                  F depth) {
  using Int = typename F::Int;
  const F width = F(static_cast<float>(frame.width)), height = F(static_cast<float>(frame.height));
  const F px = (u + motion.x) * width, py = (v + motion.y) * height;
  const auto is_inside = (px > F(-1.0f)) & (width > px) & (py > F(-1.0f)) & (height > py);
  const Int x = truncate(min(max(px, F(0.0f)), width - F(1.0f)));
  const Int y = truncate(min(max(py, F(0.0f)), height - F(1.0f)));
  const Int index = y * Int(frame.width) + x;
  const F other = velocity_of(F::gather(frame.motion, index + index), F::gather(frame.motion + 1, index + index));
  const auto moves = motion.velocity > F(0.0f);
  const F slower = F(1.0f) - saturated(other / select(moves, motion.velocity, F(1.0f)));
  const F is_same_depth = smaller_over_greater(F::gather(frame.depth, index), depth);
  return where(is_inside & moves, slower * is_same_depth * saturated(motion.velocity * F(0.1f)));
}

/// The contrast of a line or a dot: of a pixel that is lighter or darker than all the neighbours of another luma, and
/// of which no square of 2 × 2 pixels around it has one luma. 0 for other pixels.
template <class F>
[[gnu::always_inline]] inline F thin_feature(const Fsr3PrepareFrame& frame, std::int32_t y, std::size_t i) {
  using Int = typename F::Int;
  F lumas[9];
  const Int x = truncate(F::load(frame.u + i) * F(static_cast<float>(frame.width)));
  for (int k = 0; k < 9; ++k) {
    const Int column = min(max(x + Int(k % 3 - 1), Int(0)), Int(frame.width - 1));
    const std::int32_t row = std::min(std::max(y + k / 3 - 1, 0), frame.height - 1);
    lumas[k] = F::gather(frame.luma + static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width), column) *
               F(frame.exposure);
  }
  F darkest = lumas[0], lightest = lumas[0];
  for (const F& luma : lumas) darkest = min(darkest, luma), lightest = max(lightest, luma);
  const F own = lumas[4], range = lightest - darkest;
  const F scale = select(range > F(0.0f), range, F(1.0f));
  F least = F(std::numeric_limits<float>::max()), most = F(0.0f), is_similar[9];
  for (int k = 0; k < 9; ++k) {
    const auto similar = F(0.9f) > abs(lumas[k] - own) / scale;
    is_similar[k] = where(similar, F(1.0f));
    if (k == 4) continue;
    least = select(similar, least, min(least, lumas[k])), most = select(similar, most, max(most, lumas[k]));
  }
  const auto is_ridge = (own > most) | (least > own);
  const auto square = [&](int a, int b, int c) { return is_similar[a] * is_similar[b] * is_similar[c]; };
  const F solid = max(max(square(0, 1, 3), square(1, 2, 5)), max(square(3, 6, 7), square(5, 7, 8)));
  const F contrast = F(1.0f) - darkest / select(lightest > F(0.0f), lightest, F(1.0f));
  return where(is_ridge & (F(1.0f) > solid), contrast);
}

template <class F>
[[gnu::always_inline]] inline void reactivities(const Fsr3PrepareFrame& frame, std::int32_t y, std::size_t i,
                                                const Fsr3Between& shading, float* masks, float* accumulation,
                                                float* confidence) {
  const F width = F(static_cast<float>(frame.width)), height = F(static_cast<float>(frame.height));
  const F u = F::load(frame.u + i), v = F(static_cast<float>(y) + 0.5f) / height;
  const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + i;
  const Motion<F> motion(frame, pixel);
  const F depth = F::load(frame.depth + pixel);
  const F hidden = disocclusion(frame, u, v, motion, depth), change = saturated(between<F>(shading, i));

  // The history at the place to which the motion leads, with one more frame.
  const F last_u = u + motion.x, last_v = v + motion.y;
  const auto place = [](F at, F size) { return max(F(0.5f), min(at * size, size - F(0.5f))) - F(0.5f); };
  const Neighbours<F, 2> taps(frame.width, frame.height, place(last_u, width), place(last_v, height), 0);
  const auto at = [&](int r, int c) { return F::gather(frame.accumulation, taps.row[r] + taps.column[c]); };
  const F sample = mixed(mixed(at(0, 0), at(0, 1), taps.right), mixed(at(1, 0), at(1, 1), taps.right), taps.below);
  F kept = where(is_in_image(last_u, last_v), saturated(sample));
  kept = mixed(kept, F(0.0f), change);
  kept = mixed(kept, min(F(-frame_share), kept), hidden);
  kept = where(kept * F(100.0f) >= F(1.5f), kept);

  const F divergence = motion_divergence(frame, u, v, motion, depth);
  const F out[4] = {in_255_steps(divergence), in_255_steps(hidden), in_255_steps(change), in_255_steps(kept)};
  F::store_fours(out, masks + 4 * i);
  in_255_steps(kept + F(frame_share)).store(accumulation + i);
  thin_feature<F>(frame, y, i).store(confidence + i);
}

/// 1 where one of the older lumas, on the same side of the new one as the last luma is, is more similar to the new one:
/// where luma alternates.
template <class F>
[[gnu::always_inline]] inline F alternation(F luma, const F (&lumas)[4]) {
  const F first = luma - lumas[0], zero = F(0.0f);
  const F similarity = select(max(luma, lumas[0]) == zero, F(1.0f), smaller_over_greater(luma, lumas[0]));
  F most = similarity;
  for (int k = 1; k < 4; ++k) {
    const F other = luma - lumas[k];
    const auto is_same_side = ((first > zero) & (other > zero)) | ((zero > first) & (zero > other));
    most = select(is_same_side, max(most, smaller_over_greater(luma, lumas[k])), most);
  }
  return where((F(1.0f) > similarity) & (most > similarity), F(1.0f));
}

template <class F>
[[gnu::always_inline]] inline void instabilities(const Fsr3PrepareFrame& frame, std::int32_t y, std::size_t i,
                                                 const Fsr3Between& masks, const Fsr3Between& lumas,
                                                 float* luma_history, float* instability) {
  const F width = F(static_cast<float>(frame.width)), height = F(static_cast<float>(frame.height));
  const F zero = F(0.0f), one = F(1.0f);
  const F v = F(static_cast<float>(y) + 0.5f) / height;
  const Motion<F> motion(frame, static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + i);
  const F last_u = F::load(frame.u + i) + F(frame.last_jitter_x) / width + motion.x;
  const F last_v = v + F(frame.last_jitter_y) / height + motion.y;
  F mask[4];
  pixels_between(masks, i, mask);
  const auto has_history = is_in_image(last_u, last_v) & (mask[3] > F(0.9f));

  const F luma = between<F>(lumas, i) * F(frame.exposure);
  const auto place = [](F at, F size) { return max(F(0.5f), min(at * size, size - F(0.5f))) - F(0.5f); };
  const Neighbours<F, 2> taps(frame.width, frame.height, place(last_u, width), place(last_v, height), 0);
  F near[4][4], history[4];
  for (int k = 0; k < 4; ++k) taps.load(frame.luma_history, k % 2, k / 2, near[k]);
  for (int c = 0; c < 4; ++c)
    history[c] =
        mixed(mixed(near[0][c], near[1][c], taps.right), mixed(near[2][c], near[3][c], taps.right), taps.below) *
        F(frame.exposure);

  const F weight = one - saturated(motion.velocity * F(1.0f / 20));
  const F factor = alternation(luma, history) * weight * (one - mask[1]) * (one - mask[0]) * (one - mask[2]);
  const auto has_all = abs(history[2]) > zero;
  const F next[4] = {luma, history[0], history[1], history[2]};
  F out[4];
  for (int c = 0; c < 4; ++c) out[c] = where(has_history, next[c] / F(frame.exposure));
  F::store_fours(out, luma_history + 4 * i);
  where(has_history & has_all, factor).store(instability + i);
}

}  // namespace fsr3

template <class Full, class One>
[[gnu::flatten]] void fsr3_luma_row(const float* colors, float* luma, float* logarithms, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    F c[4];
    F::load_fours(colors + 4 * i, c);
    for (F& channel : c) channel = max(channel, F(0.0f));
    const F value = F(0.2126f) * c[0] + F(0.7152f) * c[1] + F(0.0722f) * c[2];
    value.store(luma + i), max(F(fsr3::epsilon), log(value)).store(logarithms + i);
  });
}

template <class Full, class One>
[[gnu::flatten]] void fsr3_difference_row(const Fsr3PrepareFrame& frame, std::int32_t y, float* out) {
  for_row<Full, One>(static_cast<std::size_t>(frame.width),
                     [&]<class F>(std::size_t i) { fsr3::differences<F>(frame, y, i, out); });
}

template <class Full, class One>
[[gnu::flatten]] void fsr3_reactivity_row(const Fsr3PrepareFrame& frame, std::int32_t y, const Fsr3Between& shading,
                                          float* masks, float* accumulation, float* confidence) {
  for_row<Full, One>(static_cast<std::size_t>(frame.width), [&]<class F>(std::size_t i) {
    fsr3::reactivities<F>(frame, y, i, shading, masks, accumulation, confidence);
  });
}

template <class Full, class One>
[[gnu::flatten]] void fsr3_instability_row(const Fsr3PrepareFrame& frame, std::int32_t y, const Fsr3Between& masks,
                                           const Fsr3Between& lumas, float* luma_history, float* instability) {
  for_row<Full, One>(static_cast<std::size_t>(frame.width), [&]<class F>(std::size_t i) {
    fsr3::instabilities<F>(frame, y, i, masks, lumas, luma_history, instability);
  });
}

template <class Full, class One>
constexpr Fsr3PrepareKernels fsr3_prepare() {
  return {.luma_row = &fsr3_luma_row<Full, One>,
          .difference_row = &fsr3_difference_row<Full, One>,
          .reactivity_row = &fsr3_reactivity_row<Full, One>,
          .instability_row = &fsr3_instability_row<Full, One>};
}

}  // namespace zoneplate::stages
