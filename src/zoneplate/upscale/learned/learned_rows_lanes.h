// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstring>

#include "zoneplate/upscale/learned/learned_network.h"
#include "zoneplate/upscale/learned/learned_rows.h"
#include "zoneplate/upscale/taau/sample_mean_rows_lanes.h"

/// LearnedKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

namespace learned {

using upscale::LearnedNetwork;

template <class F>
[[gnu::always_inline]] inline void store(const sample_mean::Past<F>& past, const HistoryRow& out, std::ptrdiff_t i) {
  const F one(1.0f);
  past.color.store(out.color + 4 * i), past.samples.store(out.count + i);
  where(past.is_inside, one).store(out.inside + i), where(past.is_filtered, one).store(out.filtered + i);
}

template <class F>
[[gnu::always_inline]] inline void gather(const SampleMeanFrame& frame, const SampleMeanRow& row, const float* own_x,
                                          const float* own_y, const GatheredRow& out, std::ptrdiff_t i) {
  const sample_mean::FramePixels<F> pixels(row, i);
  F weights;
  pixels.mean(weights, i).store(out.current + 4 * i);
  if (frame.is_first) {  // the history is black, and has no samples
    for (const HistoryRow& history : {out.near, out.own}) F(1.0f).store(history.inside + i);
    return;
  }
  const sample_mean::Past<F> near(frame, row, row.follow_x, row.follow_y, i);
  store(near, out.near, i);
  const auto is_borrowed = F::gather(row.is_borrowed, F::Int::load(row.columns[1] + i)) > F(0.0f);
  // Where it is not borrowed, both are the same within 1/16 pixel.
  if (!none(is_borrowed)) store(sample_mean::Past<F>(frame, row, own_x, own_y, i), out.own, i);
}

/// Light in [0, 1), about as bright as it is seen.
template <class F>
[[gnu::always_inline]] inline F tone(F light) {
  return sqrt(light / (F(1.0f) + light));
}

/// How far between pixels the history is that a motion comes from, as Source rounds it.
template <class F>
[[gnu::always_inline]] inline F fraction_of(F motion) {
  const F limit(65536.0f);
  const F rounded = floor(max(min(motion, limit), -limit) * F(1024.0f) + F(0.5f)) * F(1.0f / 1024);
  return -rounded - floor(-rounded);
}

/// Writes the features of pixel i in the order of features() in train/mean.py, eight at a time.
template <class F>
class Features {
 public:
  [[gnu::always_inline]] Features(std::int16_t* out, std::ptrdiff_t i) : out_(out + i * LearnedNetwork::features) {}
  /// A feature in [0, 1], as a whole number.
  [[gnu::always_inline]] void add(F value) {
    using Int = typename F::Int;
    static_assert(LearnedNetwork::features % 8 == 0);
    const F limited = min(max(value, F(0.0f)), F(1.0f));
    const Int whole = truncate(limited * F(network::Network::levels) + F(0.5f));
    const int at = next_ % 8 / 2;
    if (next_++ % 2 == 0) {
      even_ = whole;
      return;
    }
    pairs_[at] = F::of_bits(even_ + whole * Int(1 << 16));
    if (at < 3) return;
    float each[4 * F::lanes];
    F::store_fours(pairs_, each);
    for (int lane = 0; lane < F::lanes; ++lane)
      std::memcpy(out_ + lane * LearnedNetwork::features + next_ - 8, each + 4 * lane, 4 * sizeof(float));
  }

 private:
  std::int16_t* out_;
  typename F::Int even_;
  F pairs_[4];
  int next_ = 0;
};

/// The frame's colour and its surroundings.
template <class F>
[[gnu::always_inline]] inline void describe_color(const FeatureRow& row, std::ptrdiff_t i, const Rgba<F>& color,
                                                  const Rgba<F>& low, const Rgba<F>& high, Features<F>& out) {
  const F half(0.5f), two(2.0f), light = tone(luminance_of(color));
  for (int c = 0; c < 3; ++c) out.add(tone(color.c[c]));
  for (const float first : row.first) out.add(F(first * 2 + 1));
  out.add(two * (light - tone(luminance_of(low))));
  out.add(two * (tone(luminance_of(high)) - light));
  for (const float* plane : {row.alike, row.borrowed, row.steady, row.uncovered, row.kept}) out.add(F::load(plane + i));
  for (const float* plane : {row.change, row.trend}) out.add(half + half * F::load(plane + i));
}

/// The motion, and the depth around the pixel.
template <class F>
[[gnu::always_inline]] inline void describe_surface(const FeatureRow& row, std::ptrdiff_t i, const F& column,
                                                    Features<F>& out) {
  const F one(1.0f), small(1e-20f);
  const F follow[2] = {F::load(row.follow_x + i), F::load(row.follow_y + i)};
  out.add(F(0.25f) * (abs(follow[0]) + abs(follow[1])));
  for (int k = 0; k < 2; ++k) {
    const F fraction = fraction_of(follow[k] * F(row.scale[k]));
    out.add(F(4.0f) * fraction * (one - fraction));
  }

  const PastPixels<F> around(column, F(static_cast<float>(row.y)), row.width, row.height, column, i, 1);
  const F own = around.value(row.nearness, 0, 0), nearest = F::load(row.nearest + i);
  F farthest = own;
  for (const PixelOffset o : around_square) farthest = min(farthest, around.value(row.nearness, o.x, o.y));
  const F apart = (nearest - farthest) / max(nearest, small);
  out.add((nearest - own) / max(nearest - farthest, small));
  out.add(apart / (F(0.02f) + apart));
}

template <class F>
[[gnu::always_inline]] inline void describe(const FeatureRow& row, std::ptrdiff_t i) {
  const F one(1.0f), half(0.5f);
  Features<F> out(row.features, i);
  const Rgba<F> color = Rgba<F>::load(row.color + 4 * i);
  const Rgba<F> low = Rgba<F>::load(row.low + 4 * i), high = Rgba<F>::load(row.high + 4 * i);
  describe_color(row, i, color, low, high, out);
  const F column = F::load(row.column + i);
  describe_surface(row, i, column, out);

  // The four output pixels, in reading order.
  const auto is_borrowed = F::load(row.borrowed + i) > F(0.0f);
  const bool one_history = none(is_borrowed);
  F past_light[4], beyond[4], difference[4], own_difference[4];
  F count(0.0f), own_count(0.0f), inside(0.0f), apart_colors(0.0f);
  for (int k = 0; k < 4; ++k) {
    const GatheredRow& from = k < 2 ? row.above : row.below;
    const typename F::Int at = F::Int::load((k % 2 == 0 ? row.left : row.right) + i);
    std::int32_t places[F::lanes];
    at.store(places);
    const auto pixel = [&](const float* colors) {
      Rgba<F> out_color;
      load_pixels<F>([&](int lane) { return colors + std::ptrdiff_t{4} * places[lane]; }, out_color.c);
      return out_color;
    };
    const Rgba<F> past = pixel(from.near.color);
    const F current_light = tone(luminance_of(pixel(from.current)));
    past_light[k] = tone(luminance_of(past));
    difference[k] = past_light[k] - current_light;
    const Rgba<F> limited = min(max(past, low), high);
    F outside(0.0f), sum(0.02f);
    for (int c = 0; c < 3; ++c) {
      outside = outside + abs(past.c[c] - limited.c[c]), sum = sum + limited.c[c];
      apart_colors = apart_colors + abs(tone(past.c[c]) - tone(color.c[c]));
    }
    beyond[k] = outside / sum;
    const F samples = F::gather(from.near.count, at);
    count = count + samples, inside = inside + F::gather(from.near.inside, at);
    F own_samples = samples;
    own_difference[k] = difference[k];
    if (!one_history) {
      const F own_light = tone(luminance_of(pixel(from.own.color)));
      own_difference[k] = select(is_borrowed, own_light - current_light, difference[k]);
      own_samples = select(is_borrowed, F::gather(from.own.count, at) * F::gather(from.own.inside, at), samples);
    }
    own_count = own_count + own_samples;
  }
  const F quarter(0.25f), strength(1.5f);
  const F mean = (past_light[0] + past_light[1] + past_light[2] + past_light[3]) * quarter;
  for (const F& d : difference) out.add(half + strength * d);
  for (const F& l : past_light) out.add(half + strength * (l - mean));
  for (const F& b : beyond) out.add(b / (one + b));
  const F kept = F::load(row.kept + i), count_at_rest(LearnedNetwork::count_at_rest);
  count = count * quarter * kept;
  out.add(count / (count_at_rest + count));
  out.add(apart_colors * F(1.0f / 12));
  out.add(inside * quarter);
  for (const F& d : own_difference) out.add(half + strength * d);
  own_count = own_count * quarter * kept;
  out.add(own_count / (count_at_rest + own_count));

  const sample_mean::Origin<F> origin(row.column, row.y, row.follow_x, row.follow_y, i);
  const PastPixels<F> from(origin.x, origin.y, row.width, row.height, column, i, 1);
  const F before = from.value(row.past_unrest, 0, 0);
  const F now = (abs(difference[0]) + abs(difference[1]) + abs(difference[2]) + abs(difference[3])) * quarter;
  const F unrest = select(count > F(0.0f), before + (now - before) * quarter, before);
  unrest.store(row.unrest + i);
  out.add(F(4.0f) * unrest);
}

/// A history's colour, and how many of its samples count.
template <class F>
struct KeptHistory {
  Rgba<F> color;
  F count;
};

/// As sample_mean::clamped, by a part of the distance, of a part of the samples; the count is at most `most`.
template <class F>
[[gnu::always_inline]] inline KeptHistory<F> kept_of(const HistoryRow& row, const Rgba<F>& low, const Rgba<F>& high,
                                                     F clamping, F part, F most, std::ptrdiff_t i) {
  const Rgba<F> past = Rgba<F>::load(row.color + 4 * i);
  const Rgba<F> moved = (min(max(past, low), high) - past) * clamping;
  const Rgba<F> color = past + moved;
  F beyond(0.0f), sum(0.02f);
  for (int c = 0; c < 3; ++c) beyond = beyond + abs(moved.c[c]), sum = sum + abs(color.c[c]);
  const F count = min(F::load(row.count + i) * part / (F(1.0f) + beyond / sum), most);
  return {color, count * F::load(row.inside + i)};
}

template <class F>
[[gnu::always_inline]] inline void blend(const SampleMeanFrame& frame, const SampleMeanRow& row,
                                         const GatheredRow& known, const CorrectionRow& corrections, std::ptrdiff_t i) {
  const F zero(0.0f), one(1.0f), least(1e-4f);
  F correction[LearnedNetwork::corrections];  // the last quad overlaps the one before
  std::int32_t places[F::lanes];
  F::Int::load(corrections.middle + i - static_cast<std::ptrdiff_t>(corrections.begin)).store(places);
  for (int k = 0; k < 4; ++k) {
    const int first = std::min(4 * k, LearnedNetwork::corrections - 4);
    F quad[4];
    load_pixels<F>([&](int lane) { return corrections.corrections + places[lane] + first; }, quad);
    for (int c = 0; c < 4; ++c) correction[first + c] = quad[c];
  }
  const auto limited = [](F value, float low, float high) { return min(max(value, F(low)), F(high)); };
  const sample_mean::FramePixels<F> pixels(row, i);
  const typename F::Int column = F::Int::load(row.columns[1] + i);
  const F kept_by_rule = F::gather(row.kept, column), count_at_rest(LearnedNetwork::count_at_rest);
  const F freedom = F(0.5f) * (count_at_rest / (count_at_rest + F::load(known.near.count + i) * kept_by_rule));
  F usual(0.0f), changed;
  const auto weight_of = [&](int k) {
    const F weight = F::load(row.weight_x[k % 3] + i) * F(row.weight_y[k / 3]);
    usual = usual + weight;
    return max(weight + freedom * correction[k], zero);
  };
  const Rgba<F> current = pixels.mean(weight_of, 1e-4f, changed);
  // Corrections of weights change this mean, but not how much it counts.
  const F weights = usual * limited(one + correction[13], 0.1f, 4);
  const F valid = limited(one + correction[9], 0, 1);
  const F part = kept_by_rule + (one - kept_by_rule) * limited(correction[10], 0, 1);
  const F clamping = limited(one + correction[11], 0, 1);

  const Rgba<F> low = pixels.at(row.low, 1), high = pixels.at(row.high, 1);
  const auto is_filtered = [&](const HistoryRow& history) { return F::load(history.filtered + i) > zero; };
  const F most = sample_mean::max_of<F>(frame, row, is_filtered(known.near), i);
  KeptHistory<F> kept = kept_of(known.near, low, high, clamping, part, most, i);
  const auto is_borrowed = F::gather(row.is_borrowed, column) > zero;
  const F share = where(is_borrowed, limited(correction[12], 0, 1));
  if (!none(share > zero)) {
    const F own_most = select(is_filtered(known.own), F(frame.max_filtered), F(frame.most));
    const KeptHistory<F> own = kept_of(known.own, low, high, clamping, part, own_most, i);
    kept.color = select(is_borrowed, kept.color + (own.color - kept.color) * share, kept.color);
    kept.count = select(is_borrowed, kept.count + (own.count - kept.count) * share, kept.count);
  }
  const F all = kept.count * valid + weights;
  (kept.color + (current - kept.color) * (weights / max(all, least))).store(row.resolved + 4 * i);
  all.store(row.count + i);
}

}  // namespace learned

template <class Full, class One>
[[gnu::flatten]] void gather_learned(const SampleMeanFrame& frame, const SampleMeanRow& row, const float* own_x,
                                     const float* own_y, const GatheredRow& out, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    learned::gather<F>(frame, row, own_x, own_y, out, static_cast<std::ptrdiff_t>(i));
  });
}

template <class Full, class One>
[[gnu::flatten]] void describe_learned(const FeatureRow& row, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) { learned::describe<F>(row, static_cast<std::ptrdiff_t>(i)); });
}

template <class Full, class One>
[[gnu::flatten]] void blend_learned(const SampleMeanFrame& frame, const SampleMeanRow& row, const GatheredRow& known,
                                    const CorrectionRow& corrections, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    learned::blend<F>(frame, row, known, corrections, static_cast<std::ptrdiff_t>(corrections.begin + i));
  });
}

template <class Full, class One>
constexpr LearnedKernels learned_rows() {
  return {.gather = &gather_learned<Full, One>,
          .describe = &describe_learned<Full, One>,
          .blend = &blend_learned<Full, One>};
}

}  // namespace zoneplate::stages
