// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/temporal/history_lanes.h"
#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/pixel_lanes.h"
#include "zoneplate/upscale/taau/sample_mean_rows.h"

/// SampleMeanKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

namespace sample_mean {

/// Frame pixels; over the eight frames that a box lasts half a pixel.
constexpr float likeness = 1 / 16.0f;

/// The extremes of a box fade by this part of their distance from this frame's, each frame.
constexpr float fading = 1 / 8.0f;

/// The share of a frame in the trend.
constexpr float trend_share = 1 / 4.0f;

/// The pixel of the last frame that a motion comes from.
template <class F>
struct Origin {
  F x, y;

  [[gnu::always_inline]] Origin(const float* column, std::int32_t row, const float* motion_x, const float* motion_y,
                                std::ptrdiff_t i) {
    const F half(0.5f), limit(65536.0f);
    const auto bounded = [&](F v) { return min(max(v, -limit), limit); };
    x = floor(F::load(column + i) - bounded(F::load(motion_x + i)) + half);
    y = floor(F(static_cast<float>(row)) - bounded(F::load(motion_y + i)) + half);
  }
  [[gnu::always_inline]] typename F::Bool is_inside(std::int32_t width, std::int32_t height) const {
    const F zero(0.0f), last_x(static_cast<float>(width - 1)), last_y(static_cast<float>(height - 1));
    return (x >= zero) & (y >= zero) & (last_x >= x) & (last_y >= y);
  }
};

template <class F>
[[gnu::always_inline]] inline void survey(const SurveyRow& row, std::ptrdiff_t i) {
  const F column = F::load(row.column + i);
  const PastPixels<F> around(column, F(static_cast<float>(row.y)), row.width, row.height, column, i, 1);
  F nearest = around.value(row.nearness, 0, 0);
  const F own_x = around.value(row.motion_x, 0, 0), own_y = around.value(row.motion_y, 0, 0);
  F x = own_x, y = own_y;
  F least[2] = {x, y}, most[2] = {x, y};
  for (const PixelOffset o : around_square) {
    const F nearness = around.value(row.nearness, o.x, o.y);
    const F other_x = around.value(row.motion_x, o.x, o.y), other_y = around.value(row.motion_y, o.x, o.y);
    least[0] = min(least[0], other_x), most[0] = max(most[0], other_x);
    least[1] = min(least[1], other_y), most[1] = max(most[1], other_y);
    const auto is_nearer = nearness > nearest;
    nearest = select(is_nearer, nearness, nearest);
    x = select(is_nearer, other_x, x), y = select(is_nearer, other_y, y);
  }
  nearest.store(row.nearest + i), x.store(row.follow_x + i), y.store(row.follow_y + i);
  const F limit(likeness), one(1.0f);
  const auto is_alike =
      (limit >= most[0] - x) & (limit >= x - least[0]) & (limit >= most[1] - y) & (limit >= y - least[1]);
  where(is_alike, one).store(row.is_alike + i);
  where((abs(x - own_x) > limit) | (abs(y - own_y) > limit), one).store(row.is_borrowed + i);
  around.with_colors(row.color, [&](const auto& color) {
    Rgba<F> low = color(0, 0), high = low;
    for (const PixelOffset o : around_square) {
      const Rgba<F> c = color(o.x, o.y);
      low = min(low, c), high = max(high, c);
    }
    low.store(row.low + 4 * i), high.store(row.high + 4 * i);
    return 0;
  });
}

template <class F>
[[gnu::always_inline]] inline void compare(const CompareRow& row, std::ptrdiff_t i) {
  using Int = typename F::Int;
  const F zero(0.0f), one(1.0f), limit(likeness);
  const Origin<F> origin(row.column, row.y, row.follow_x, row.follow_y, i);
  const F x = F::load(row.follow_x + i), y = F::load(row.follow_y + i), column = F::load(row.column + i);
  const PastPixels<F> past(origin.x, origin.y, row.width, row.height, column, i, 1);
  const auto is_inside = origin.is_inside(row.width, row.height);
  const auto came_alike = [&](int dx, int dy) {
    const auto moved = [&](int side) { return past.value(row.moved[side], dx, dy); };
    return (limit >= x - moved(0)) & (limit >= moved(1) - x) & (limit >= y - moved(2)) & (limit >= moved(3) - y);
  };
  const auto is_covered = past.value(row.moved_nearest, 0, 0) > F::load(row.nearest + i);
  where(is_inside & is_covered, select(came_alike(0, 0), zero, one)).store(row.is_uncovered + i);

  auto is_steady = is_inside & (F::load(row.is_alike + i) > zero);
  // Where the sample was in the last output.
  const F place[2] = {floor((column + F(row.sample[0]) - x) * F(row.scale[0])),
                      floor((F(static_cast<float>(row.y)) + F(row.sample[1]) - y) * F(row.scale[1]))};
  const F last[2] = {F(static_cast<float>(row.history_width - 1)), F(static_cast<float>(row.history_height - 1))};
  for (int k = 0; k < 2; ++k) is_steady = is_steady & (place[k] >= zero) & (last[k] >= place[k]);
  if (none(is_steady)) {
    for (float* const out : {row.is_steady, row.change, row.trend}) zero.store(out + i);
    return;
  }

  is_steady = is_steady & (past.value(row.past_alike, 0, 0) > zero);
  for (int k = 0; k < 9; ++k) is_steady = is_steady & came_alike(k % 3 - 1, k / 3 - 1);
  where(is_steady, one).store(row.is_steady + i);

  // Darker and brighter samples than the last box allows: by a tenth, and by half a code of a dark colour.
  const Rgba<F> color = Rgba<F>::load(row.color + 4 * i);
  const F part(0.05f), least(0.002f);
  const Rgba<F> low = past.with_colors(row.past_low, [](const auto& c) { return c(0, 0); });
  const Rgba<F> high = past.with_colors(row.past_high, [](const auto& c) { return c(0, 0); });
  auto is_above = one > one, is_below = one > one;
  for (int c = 0; c < 3; ++c) {
    const F slack = part * (low.c[c] + high.c[c]) + least;
    is_above = is_above | (color.c[c] > high.c[c] + slack);
    is_below = is_below | (low.c[c] - slack > color.c[c]);
  }
  where(is_steady, select(is_above, one, where(is_below, -one))).store(row.change + i);

  // Half a percent, or a code of a dark colour, is not seen.
  const Int pixel = truncate(min(max(place[1], zero), last[1])) * Int(row.history_width) +
                    truncate(min(max(place[0], zero), last[0]));
  std::int32_t at[F::lanes];
  pixel.store(at);
  Rgba<F> old;
  load_pixels<F>([&](int lane) { return row.history + std::ptrdiff_t{4} * at[lane]; }, old.c);
  const F before = luminance_of(old), difference = luminance_of(color) - before;
  const auto is_seen = abs(difference) > F(0.005f) * before + F(0.0003f);
  const F sign = where(is_seen, select(difference > zero, one, -one)), trend = past.value(row.past_trend, 0, 0);
  where(is_steady, trend + (sign - trend) * F(trend_share)).store(row.trend + i);
}

template <class F>
[[gnu::always_inline]] inline void widen(const WidenRow& row, std::ptrdiff_t i) {
  const F zero(0.0f), one(1.0f), column = F::load(row.column + i);
  // The light drifts where half of 5 × 5 trends agree; where eight tenths do, no history counts.
  constexpr int radius = 2;
  const PastPixels<F> around(column - one, F(static_cast<float>(row.y - 1)), row.width, row.height, column, i,
                             radius + 1);
  F sum(0.0f);
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) sum = sum + around.value(row.trend, dx + 1, dy + 1);
  const F drift = saturated((abs(sum) * F(1 / 25.0f) - F(0.5f)) * F(1 / 0.3f));
  const auto begins = (F::load(row.restarts + i) > zero) | (F::load(row.is_uncovered + i) > zero);
  const F lost = select(begins, one, drift);
  (one - lost).store(row.kept + i);

  const auto is_steady = F::load(row.is_steady + i) > zero;
  if (none(is_steady)) return;
  const Origin<F> origin(row.column, row.y, row.follow_x, row.follow_y, i);
  const PastPixels<F> past(origin.x, origin.y, row.width, row.height, column, i, 1);
  const F faded = max(lost, F(fading));
  const Rgba<F> low = Rgba<F>::load(row.low + 4 * i), high = Rgba<F>::load(row.high + 4 * i);
  const auto widened = [&](const float* plane, const Rgba<F>& now) {
    const Rgba<F> before = past.with_colors(plane, [](const auto& c) { return c(0, 0); });
    return before + (now - before) * faded;
  };
  select(is_steady, min(low, widened(row.past_low, low)), low).store(row.low + 4 * i);
  select(is_steady, max(high, widened(row.past_high, high)), high).store(row.high + 4 * i);
}

/// The history's colour, between the extremes; and the number of its samples, less where it was beyond them.
template <class F>
struct Kept {
  Rgba<F> color;
  F count;
};

template <class F>
[[gnu::always_inline]] inline Kept<F> clamped(const Rgba<F>& history, F count, const Rgba<F>& low,
                                              const Rgba<F>& high) {
  const Rgba<F> inside = min(max(history, low), high);
  F beyond(0.0f), sum(0.02f);
  for (int c = 0; c < 3; ++c) beyond = beyond + abs(history.c[c] - inside.c[c]), sum = sum + inside.c[c];
  return {inside, count / (F(1.0f) + beyond / sum)};
}

/// The frame's pixels around those of an output row.
template <class F>
class FramePixels {
 public:
  [[gnu::always_inline]] FramePixels(const SampleMeanRow& row, std::ptrdiff_t i) : row_(row) {
    for (int c = 0; c < 3; ++c) F::Int::load(row.columns[c] + i).store(columns_[c]);
  }
  /// Of a row of the frame, in the column that is the first, second or third of those around.
  [[gnu::always_inline]] Rgba<F> at(const float* pixels, int c) const {
    Rgba<F> out;
    load_pixels<F>([&](int lane) { return pixels + std::ptrdiff_t{4} * columns_[c][lane]; }, out.c);
    return out;
  }
  /// The mean of the frame's samples with weights weight_of(k), whose sum becomes `weights`: of differences from the
  /// middle one, so that equal samples have their own value. A sum below `least` counts as that.
  template <class WeightOf>
  [[gnu::always_inline]] Rgba<F> mean(const WeightOf& weight_of, float least, F& weights) const {
    const Rgba<F> middle = at(row_.color[1], 1);
    Rgba<F> sum = Rgba<F>::all(F(0.0f));
    weights = F(0.0f);
    for (int k = 0; k < 9; ++k) {
      const F weight = weight_of(k);
      weights = weights + weight;
      if (k != 4) sum = sum + (at(row_.color[k / 3], k % 3) - middle) * weight;
    }
    return max(middle + sum * (F(1.0f) / max(weights, F(least))), Rgba<F>::all(F(0.0f)));
  }
  /// The same with the weights of the distance.
  [[gnu::always_inline]] Rgba<F> mean(F& weights, std::ptrdiff_t i) const {
    return mean([&](int k) { return F::load(row_.weight_x[k % 3] + i) * F(row_.weight_y[k / 3]); }, 0, weights);
  }

 private:
  const SampleMeanRow& row_;
  std::int32_t columns_[3][F::lanes];
};

/// The history of an output row's pixels, and the number of its samples.
template <class F>
struct Past {
  Rgba<F> color;
  F samples;
  typename F::Bool is_inside, is_filtered;

  /// The motion is that of the frame's pixels, in a row of them.
  [[gnu::always_inline]] Past(const SampleMeanFrame& frame, const SampleMeanRow& row, const float* motion_x,
                              const float* motion_y, std::ptrdiff_t i) {
    const TemporalRow history_row{.column = row.column, .y = row.y, .width = frame.width, .height = frame.height};
    const typename F::Int column = F::Int::load(row.columns[1] + i);
    Followed<F> surface{};
    surface.motion[0] = F::gather(motion_x, column) * F(frame.scale[0]);
    surface.motion[1] = F::gather(motion_y, column) * F(frame.scale[1]);
    const Source<F> source(surface, history_row, i);
    constexpr TemporalParts parts{.filter = TemporalParts::Filter::CatmullRom5};
    color = history_of(frame.history, history_row, parts, source, i);
    const PastPixels<F> around = pixels_around(history_row, source, i);
    const F right = source.fraction[0], below = source.fraction[1], zero(0.0f);
    const auto count = [&](int dy) {
      return mixed(around.value(frame.count, 0, dy), around.value(frame.count, 1, dy), right);
    };
    samples = mixed(count(0), count(1), below);
    is_inside = source.is_inside;
    is_filtered = (right > zero) | (below > zero);
  }
};

/// The greatest number of samples that counts.
template <class F>
[[gnu::always_inline]] inline F max_of(const SampleMeanFrame& frame, const SampleMeanRow& row,
                                       typename F::Bool is_filtered, std::ptrdiff_t i) {
  const F most = select(is_filtered, F(frame.max_filtered), F(frame.most));
  const F borrowed = F::gather(row.is_borrowed, F::Int::load(row.columns[1] + i));
  return select(borrowed > F(0.0f), min(most, F(frame.max_borrowed)), most);
}

template <class F>
[[gnu::always_inline]] inline void resolve(const SampleMeanFrame& frame, const SampleMeanRow& row, std::ptrdiff_t i) {
  const FramePixels<F> pixels(row, i);
  F weights;
  const Rgba<F> current = pixels.mean(weights, i);
  if (frame.is_first) {
    current.store(row.resolved + 4 * i), weights.store(row.count + i);
    return;
  }
  const Past<F> past(frame, row, row.follow_x, row.follow_y, i);
  const F samples = past.samples * F::gather(row.kept, F::Int::load(row.columns[1] + i));
  const Kept<F> kept = clamped(past.color, samples, pixels.at(row.low, 1), pixels.at(row.high, 1));
  const F all = min(kept.count, max_of<F>(frame, row, past.is_filtered, i)) + weights;
  const Rgba<F> mean = kept.color + (current - kept.color) * (weights / all);
  select(past.is_inside, mean, current).store(row.resolved + 4 * i);
  select(past.is_inside, all, weights).store(row.count + i);
}

}  // namespace sample_mean

template <class Full, class One>
[[gnu::flatten]] void survey_samples(const SurveyRow& row, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) { sample_mean::survey<F>(row, static_cast<std::ptrdiff_t>(i)); });
}

template <class Full, class One>
[[gnu::flatten]] void compare_samples(const CompareRow& row, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) { sample_mean::compare<F>(row, static_cast<std::ptrdiff_t>(i)); });
}

template <class Full, class One>
[[gnu::flatten]] void widen_boxes(const WidenRow& row, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) { sample_mean::widen<F>(row, static_cast<std::ptrdiff_t>(i)); });
}

template <class Full, class One>
[[gnu::flatten]] void resolve_samples(const SampleMeanFrame& frame, const SampleMeanRow& row, std::size_t n) {
  for_row<Full, One>(
      n, [&]<class F>(std::size_t i) { sample_mean::resolve<F>(frame, row, static_cast<std::ptrdiff_t>(i)); });
}

template <class Full, class One>
constexpr SampleMeanKernels sample_mean_rows() {
  return {.survey = &survey_samples<Full, One>,
          .compare = &compare_samples<Full, One>,
          .widen = &widen_boxes<Full, One>,
          .resolve = &resolve_samples<Full, One>};
}

}  // namespace zoneplate::stages
