// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/blend_lanes.h"
#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/pixel_lanes.h"
#include "zoneplate/upscale/sgsr/sgsr2_rows.h"

/// Sgsr2Kernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

namespace sgsr2 {

constexpr float smallest_difference = 1.19e-7f;  // of depths

/// GLSL's `mix` as its specification defines it: both ends are exact. Rounding matters, since the history that an image
/// leaves lies on the border of the colours around it wherever a channel is constant.
template <class F>
[[gnu::always_inline]] inline F mix(F a, F b, F t) {
  return a * (F(1.0f) - t) + b * t;
}

template <class F>
[[gnu::always_inline]] inline F least(F a, F b, F c, F d) {
  return min(min(a, b), min(c, d));
}

template <class F>
[[gnu::always_inline]] inline void convert_pixels(const Sgsr2ConvertFrame& frame, const Sgsr2ConvertRow& row,
                                                  std::size_t i) {
  const F zero = F(0.0f), one = F(1.0f);
  F d[4][4];  // depths around: rows -1 to 2, columns -1 to 2
  for (std::size_t r = 0; r < 4; ++r)
    for (std::size_t c = 0; c < 4; ++c) d[r][c] = F::load(row.depth[r] + i + c - 1);
  const F middle = least(d[1][1], d[1][2], d[2][1], d[2][2]);
  const F corners[4] = {least(d[0][0], d[0][1], d[1][0], d[1][1]), least(d[0][2], d[0][3], d[1][2], d[1][3]),
                        least(d[2][0], d[2][1], d[3][0], d[3][1]), least(d[2][2], d[2][3], d[3][2], d[3][3])};
  const F nearest = min(least(middle, corners[0], d[2][0], d[0][2]), one);
  const F separation = F(frame.separation) * (one - middle);
  F same = zero;
  for (const F corner : corners) same = same + saturated(separation / (abs(middle - corner) + F(smallest_difference)));
  const F clip = where(F(1.0f - 1e-5f) > middle, saturated(one - same * F(0.25f)));

  // Points at rest move as the camera's motion moves the nearest of nine depths.
  const F x = F::load(row.x + i), y = F(row.y);
  const auto& m = frame.last_clip_from_clip;
  const auto last = [&](int k) { return F(m[3][k]) + (F(m[2][k]) * nearest + (F(m[1][k]) * y + F(m[0][k]) * x)); };
  const F w = last(3);
  const F own_x = F::load(row.motion_x + i), own_y = F::load(row.motion_y + i);
  const auto is_object = own_x == own_x;
  const F motion_x = select(is_object, own_x, x - last(0) / w);
  const F motion_y = select(is_object, own_y, y - last(1) / w);

  F pixel[4];
  load_pixels<F>([&](int lane) { return row.color + 4 * (i + static_cast<std::size_t>(lane)); }, pixel);
  for (F& c : pixel) c = min(max(c, zero), F(65504.0f));
  const F greatest = max(max(pixel[0], pixel[1]), pixel[2]) + one;
  const F r = pixel[0] / greatest, g = pixel[1] / greatest, b = pixel[2] / greatest;
  const F luma = F(0.25f) * (r + F(2.0f) * g + b);
  const F orange = saturated(F(0.5f) * r + F(0.5f) - F(0.5f) * b), green = saturated(luma + orange - r);
  const auto code = [](F v, float steps) { return F::from(truncate(v * F(steps))); };
  const F ycocg[4] = {code(luma, 2047.5f) * F(1.0f / 2047.5f), code(orange, 2047.5f) * F(1.0f / 2047.5f) - F(0.5f),
                      code(green, 1023.5f) * F(1.0f / 1023.5f) - F(0.5f), zero};
  const F motion_clip[4] = {motion_x, motion_y, clip, greatest};
  F::store_fours(motion_clip, row.motion_clip + 4 * i), F::store_fours(ycocg, row.ycocg + 4 * i);
}

template <class F>
[[gnu::always_inline]] inline void load_columns(const float* row, const std::int32_t* columns, std::size_t i,
                                                F (&out)[4]) {
  std::int32_t column[F::lanes];
  F::Int::load(columns + i).store(column);
  load_pixels<F>([&](int lane) { return row + column[lane]; }, out);
}

/// The history of the last frame at a position in [0, 1], by bilinear interpolation.
template <class F>
[[gnu::always_inline]] inline void sample_history(const Sgsr2UpscaleFrame& frame, F u, F v, F (&out)[4]) {
  using Int = typename F::Int;
  const F x = u * F(static_cast<float>(frame.width)) - F(0.5f), y = v * F(static_cast<float>(frame.height)) - F(0.5f);
  const F left = floor(x), top = floor(y), right = x - left, below = y - top;
  const auto within = [](Int at, std::int32_t size) { return min(max(at, Int(0)), Int(size - 1)); };
  F rows[2][4];
  for (int r = 0; r < 2; ++r) {
    const Int first = within(truncate(top) + Int(r), frame.height) * Int(frame.width);
    F pixels[2][4];
    for (int c = 0; c < 2; ++c) {
      std::int32_t index[F::lanes];
      (first + within(truncate(left) + Int(c), frame.width)).store(index);
      load_pixels<F>([&](int lane) { return frame.history + std::size_t{4} * static_cast<std::size_t>(index[lane]); },
                     pixels[c]);
    }
    for (int c = 0; c < 3; ++c) rows[r][c] = mixed(pixels[0][c], pixels[1][c], right);
  }
  for (int c = 0; c < 3; ++c) out[c] = mixed(rows[0][c], rows[1][c], below);
}

template <class F>
[[gnu::always_inline]] inline void upscale_pixels(const Sgsr2UpscaleFrame& frame, const Sgsr2UpscaleRow& row,
                                                  std::size_t i) {
  const F zero = F(0.0f), one = F(1.0f);
  F motion_clip[4];
  {
    const F right = F::load(row.motion_right + i), below = F(row.motion_below);
    F around[2][2][4];
    for (int r = 0; r < 2; ++r)
      for (int c = 0; c < 2; ++c) load_columns<F>(row.motion_clip[r], row.motion_columns[c], i, around[r][c]);
    for (int k = 0; k < 4; ++k)
      motion_clip[k] =
          mixed(mixed(around[0][0][k], around[0][1][k], right), mixed(around[1][0][k], around[1][1][k], right), below);
  }
  const F motion_x = motion_clip[0], motion_y = motion_clip[1], clip = motion_clip[2], greatest = motion_clip[3];
  F history[4] = {zero, zero, zero, zero};
  if (!frame.is_first)
    sample_history<F>(frame, saturated(F::load(row.u + i) - F(0.5f) * motion_x),
                      saturated(F(row.v) - F(0.5f) * motion_y), history);

  const F kernel_max = F(frame.is_first ? 0.0f : frame.kernel_max),
          kernel_min = max(one, F(0.3f) + F(0.3f) * kernel_max);
  const F kernel = F(0.5f) * mix(kernel_max, kernel_min, frame.is_first ? one : F(0.25f) * clip);
  const F kernel2 = kernel * kernel;
  const F px = motion_x * F(static_cast<float>(frame.width)), py = motion_y * F(static_cast<float>(frame.height));
  const F velocity = sqrt(px * px + py * py);
  const F curve = mix(F(-2.0f), F(-3.0f), saturated(velocity * F(0.02f)));

  // The frame's samples: mean by a narrow kernel, and mean, deviation and range for what history may be.
  static constexpr int places[9][2] = {{0, 1}, {1, 0}, {-1, 0}, {0, 0}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
  const F dx = F::load(row.dx + i), dy = F(row.dy);
  F sum[3] = {zero, zero, zero}, mean[3] = {zero, zero, zero}, square[3] = {zero, zero, zero}, low[3], high[3];
  F weight = zero, box_weight = zero;
  for (int k = 0; k < frame.taps; ++k) {
    const int* const place = places[k];
    F pixel[4];
    load_columns<F>(row.ycocg[place[1] + 1], row.columns[place[0] + 1], i, pixel);
    const F x = dx + F(static_cast<float>(place[0])), y = dy + F(static_cast<float>(place[1])), d2 = x * x + y * y;
    const F t = saturated(d2 * kernel2) - one, t2 = t * t, w = (F(0.75f) * t + t2) * t2, box = exp(d2 * curve);
    for (int c = 0; c < 3; ++c) {
      sum[c] = sum[c] + pixel[c] * w;
      low[c] = k == 0 ? pixel[c] : min(low[c], pixel[c]), high[c] = k == 0 ? pixel[c] : max(high[c], pixel[c]);
      const F weighted = pixel[c] * box;
      mean[c] = mean[c] + weighted, square[c] = square[c] + pixel[c] * weighted;
    }
    weight = weight + w, box_weight = box_weight + box;
  }
  const F box_inverse = one / box_weight, third = weight * F(1.0f / 3);

  F base = one - clip;
  base = min(base, mix(base, third * F(10.0f), saturated(F(10.0f) * velocity)));
  base = min(base, mix(base, third, saturated(velocity * F(0.05f))));
  const F deviations = mix(F(frame.box_scale), one, max(clip, saturated(velocity * F(0.05f))));
  F fresh[3], clamped[3];
  auto is_outside = zero > one;
  for (int c = 0; c < 3; ++c) {
    fresh[c] = min(max(sum[c] / weight, low[c] - F(0.05f)), high[c] + F(0.05f));
    mean[c] = mean[c] * box_inverse;
    const F half = sqrt(abs(square[c] * box_inverse - mean[c] * mean[c])) * deviations;
    const F bottom = max(low[c], mean[c] - half), top = min(high[c], mean[c] + half);
    clamped[c] = min(max(history[c], bottom), top);
    is_outside = is_outside | (bottom > history[c]) | (history[c] > top);
  }
  const auto moves = abs(motion_x) + abs(motion_y) > F(1e-6f);
  const F kept = select(is_outside, select(moves, zero, F(frame.rest_share)), one);
  base = mix(min(base, F(0.1f)), base, kept);
  const F alpha = saturated(third / max(F(1.192e-7f), base + third) + F(frame.is_first ? 1.0f : 0.0f));
  F out[4] = {zero, zero, zero, zero};
  for (int c = 0; c < 3; ++c) out[c] = mix(mix(clamped[c], history[c], kept), fresh[c], alpha);
  F::store_fours(out, row.history + 4 * i);

  const F low_sum = out[0] - out[2];
  F color[4] = {saturated(low_sum + out[1]), saturated(out[0] + out[2]), saturated(low_sum - out[1]), one};
  const F light = one / (F(1 + 600.0f / 65504) - max(max(color[0], color[1]), color[2]));
  const F scale = select(greatest > F(4000.0f), greatest, light);
  for (int c = 0; c < 3; ++c) color[c] = color[c] * scale;
  F::store_fours(color, row.color + 4 * i);
}

}  // namespace sgsr2

template <class Full, class One>
[[gnu::flatten]] void sgsr2_convert_row(const Sgsr2ConvertFrame& frame, const Sgsr2ConvertRow& row, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) { sgsr2::convert_pixels<F>(frame, row, i); });
}

template <class Full, class One>
[[gnu::flatten]] void sgsr2_upscale_row(const Sgsr2UpscaleFrame& frame, const Sgsr2UpscaleRow& row, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) { sgsr2::upscale_pixels<F>(frame, row, i); });
}

template <class Full, class One>
constexpr Sgsr2Kernels sgsr2_rows() {
  return {.convert_row = &sgsr2_convert_row<Full, One>, .upscale_row = &sgsr2_upscale_row<Full, One>};
}

}  // namespace zoneplate::stages
