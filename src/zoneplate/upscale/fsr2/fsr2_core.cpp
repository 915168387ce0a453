// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr2/fsr2_core.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "zoneplate/math/elementary.h"
#include "zoneplate/upscale/fsr/sample_axis.h"
#include "zoneplate/upscale/fsr2/accumulate.h"

namespace zoneplate::upscale {
namespace {

using namespace fsr;

constexpr float min_weight = 0.01f;  // of a bilinear sample of depth

float length(float x, float y) { return length(float2{x, y}); }
float positive_power(float v, float exponent) { return v > 0 ? pow(v, exponent) : 0.0f; }

/// The logarithm of the luminance at the unjittered centres.
Plane<float> log_luminances(const FsrFrame& frame) {
  const int width = frame.color.width(), height = frame.color.height();
  Plane<float> luma(width, height), out(width, height);
  for_rows(height, [&](int y) { std::ranges::transform(frame.color.row(y), luma.row(y).begin(), luma709); });
  for_rows(height, [&](int y) {
    const float py = std::clamp(static_cast<float>(y) + frame.jitter.y, 0.0f, static_cast<float>(height - 1));
    for (int x = 0; x < width; ++x) {
      const float px = std::clamp(static_cast<float>(x) + frame.jitter.x, 0.0f, static_cast<float>(width - 1));
      float sum = 0;
      BilinearTaps(px, py).for_each([&](int i, int j, float w) { sum += w * at_clamped(luma, i, j); });
      out(x, y) = log(std::max(1e-3f, sum));
    }
  });
  return out;
}

struct Pyramid {
  Plane<float> blocks;  ///< of 32 × 32 pixels
  float mean;           ///< of the square of the greatest power of two within the longer side, from the top left
};
Pyramid pyramid_of(Plane<float> level) {
  Pyramid out{{}, level(0, 0)};
  int levels = 0;
  while (2 << levels <= std::max(level.width(), level.height())) ++levels;
  const int block_columns = std::max(1, level.width() / 32), block_rows = std::max(1, level.height() / 32);
  for (int k = 1; k <= std::max(5, levels); ++k) {
    level = halved(level);
    if (k == levels) out.mean = level(0, 0);
    if (k != 5) continue;
    out.blocks = Plane<float>(block_columns, block_rows);
    for (int y = 0; y < block_rows; ++y) std::copy_n(level.row(y).begin(), block_columns, out.blocks.row(y).begin());
  }
  return out;
}

/// The luma by which thin features are detected.
float lock_luma_of(const Linear& c, float exposure) {
  const auto exposed = [&](float v) { return std::max(v, 0.0f) * exposure; };
  const Linear e{exposed(c.r), exposed(c.g), exposed(c.b), 1};
  const float luminance = luma709(e * (1 / (std::max({e.r, e.g, e.b}) + 1)));
  const float lightness =
      luminance <= 216.0f / 24389 ? luminance * (24389.0f / 27) : positive_power(luminance, 1.0f / 3) * 116 - 16;
  return positive_power(lightness * 0.01f, 1.0f / 6);
}

/// The share of a pixel that was hidden in the last frame.
class DepthClip {
 public:
  DepthClip(const FsrFrame& frame, const Fsr2Passes& passes, float2 output)
      : passes_(passes), previous_(passes.previous_depth), output_(output) {
    const auto width = static_cast<float>(previous_.width()), height = static_cast<float>(previous_.height());
    separation_ = 1.37e-5f * frame.corner * length(width, height);
    power_ = 1 + 2 * saturated(length(width, height) / length(1920.0f, 1080.0f));
  }

  float operator()(int x, int y) const {
    float2 motion = passes_.dilated.motion(x, y);
    if (!(length(motion.x * output_.x, motion.y * output_.y) > 0.01f)) motion = {0, 0};
    const float px = static_cast<float>(x) + motion.x * static_cast<float>(previous_.width());
    const float py = static_cast<float>(y) + motion.y * static_cast<float>(previous_.height());
    const bool is_near_image = px > -2 && py > -2 && px < static_cast<float>(previous_.width() + 1) &&
                               py < static_cast<float>(previous_.height() + 1);
    if (!is_near_image) return 0;
    const float depth = passes_.dilated.depth(x, y);
    float seen = 0, sum = 0;
    BilinearTaps(px, py).for_each([&](int i, int j, float w) {
      if (!contains(previous_, i, j) || !(w > min_weight)) return;
      const float behind = depth - previous_(i, j);
      if (!(behind > 0)) return;
      const float required = separation_ * std::max(depth, previous_(i, j));
      seen += positive_power(saturated(required / behind), power_) * w, sum += w;
    });
    if (!(sum > 0)) return 0;
    return is_steep(x, y) ? 0 : saturated(1 - seen / sum);
  }

 private:
  /// True for a surface that comes nearer steadily from above to below: there the last frame's depth says nothing.
  bool is_steep(int x, int y) const {
    const auto depth = [&](int row) { return contains(previous_, x, row) ? previous_(x, row) : FsrFrame::far; };
    const float d0 = depth(y - 1), d1 = depth(y), d2 = depth(y + 1);
    return d0 - d1 > d1 * 0.01f && d1 - d2 > d2 * 0.01f;
  }

  const Fsr2Passes& passes_;
  const Plane<float>& previous_;
  float2 output_;
  float separation_, power_;
};

/// Where neighbouring surfaces move in different directions.
float motion_divergence(const Plane<float2>& motion, int x, int y) {
  const auto width = static_cast<float>(motion.width()), height = static_cast<float>(motion.height());
  const auto uv = [&](float2 m) { return float2{m.x / width, m.y / height}; };
  const float2 own = uv(motion(x, y));
  float greatest = length(own), min_agreement = 1;
  if (length(motion(x, y)) > 0.01f)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const float2 other = uv(at_clamped(motion, x + dx, y + dy));
        greatest = std::max(length(other), greatest);
        const float2 a{other.x / greatest, other.y / greatest}, b{own.x / greatest, own.y / greatest};
        min_agreement = std::min(min_agreement, a.x * b.x + a.y * b.y);
      }
  return saturated(1 - min_agreement) * saturated(greatest / 0.01f);
}

/// 1 - the least over the greatest depth of 3 × 3 pixels; beyond the frame depth is 0. 0 next to empty pixels.
float depth_divergence(const Plane<float>& depth, int x, int y) {
  float least = FsrFrame::far, greatest = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const float d = contains(depth, x + dx, y + dy) ? depth(x + dx, y + dy) : 0.0f;
      if (d == FsrFrame::far) return 0;
      least = std::min(least, d), greatest = std::max(greatest, d);
    }
  return 1 - least / greatest;
}

/// How much faster a surface moves than it did in the last frame.
float acceleration(const Fsr2Passes& passes, const Plane<float2>& last, float2 output, int x, int y) {
  const float2 motion = passes.dilated.motion(x, y);
  const float pixels = length(motion.x * output.x, motion.y * output.y);
  if (!(pixels > 1) || last.empty()) return 0;
  const auto place = [](int i, float m, int size) {
    return std::clamp(static_cast<float>(i) + m * static_cast<float>(size), 0.0f, static_cast<float>(size - 1));
  };
  float2 before{0, 0};
  BilinearTaps(place(x, motion.x, last.width()), place(y, motion.y, last.height()))
      .for_each([&](int i, int j, float w) {
        const float2 m = at_clamped(last, i, j);
        before = {before.x + w * m.x, before.y + w * m.y};
      });
  const float share = pixels / 20;
  return saturated(share * share * share) * (1 - saturated(length(before) / length(motion)));
}

/// Whether a pixel is part of a line or a dot: no square of 2 × 2 pixels around it has one luma, and it is lighter or
/// darker than all pixels of other lumas.
bool is_thin_feature(const Plane<float>& luma, int x, int y) {
  constexpr float similar = 1.05f;
  const float own = luma(x, y);
  float darkest = std::numeric_limits<float>::max(), lightest = 0;
  unsigned mask = 1u << 4;
  for (int k = 0; k < 9; ++k) {
    if (k == 4) continue;
    const float other = at_clamped(luma, x + k % 3 - 1, y + k / 3 - 1);
    const float ratio = std::max(other, own) / std::min(other, own);
    if (ratio > 0 && ratio < similar)
      mask |= 1u << k;
    else
      darkest = std::min(darkest, other), lightest = std::max(lightest, other);
  }
  if (!(own > lightest || own < darkest)) return false;
  constexpr unsigned squares[] = {0b000'011'011, 0b000'110'110, 0b011'011'000, 0b110'110'000};
  return std::ranges::none_of(squares, [&](unsigned square) { return (mask & square) == square; });
}

/// New locks at the output pixels that contain the samples of thin features.
void lock_thin_features(const Plane<float>& luma, float2 jitter, Plane<float>& out) {
  auto is_thin = Plane<std::uint8_t>::unset(luma.width(), luma.height());
  for_rows(luma.height(), [&](int y) {
    for (int x = 0; x < luma.width(); ++x) is_thin(x, y) = is_thin_feature(luma, x, y) ? 1 : 0;
  });
  for (int y = 0; y < luma.height(); ++y)
    for (int x = 0; x < luma.width(); ++x) {
      if (is_thin(x, y) == 0) continue;
      const auto place = [](int i, float shift, int from, int to) {
        const float centre = (static_cast<float>(i) + 0.5f - shift) / static_cast<float>(from);
        return static_cast<int>(std::floor(centre * static_cast<float>(to)));
      };
      const int i = place(x, jitter.x, luma.width(), out.width());
      const int j = place(y, jitter.y, luma.height(), out.height());
      if (contains(out, i, j)) out(i, j) = 1;
    }
}

}  // namespace

LinearImage Fsr2::accumulate(const FsrFrame& frame, LinearImage memory) {
  const int frame_width = frame.color.width(), frame_height = frame.color.height();
  const float2 output{static_cast<float>(width_), static_cast<float>(height_)};
  const bool is_first = frame.is_first || history_.empty();
  const Plane<float2> none;
  const Plane<float2>& last_motion = is_first ? none : last_motion_;

  Pyramid pyramid = pyramid_of(log_luminances(frame));
  const float rate = 1 - exp(-options_.frame_seconds);
  log_luminance_ = is_first ? pyramid.mean : log_luminance_ + (pyramid.mean - log_luminance_) * rate;
  passes_.exposure = options_.exposure > 0 ? options_.exposure : automatic_exposure(log_luminance_);
  passes_.luminance = std::move(pyramid.blocks);

  dilate(frame, passes_.dilated);
  passes_.previous_depth = previous_depth(passes_.dilated, min_weight, [&](float2 motion, float) {
    return length(motion.x * output.x, motion.y * output.y) > 0.1f;
  });
  if (passes_.prepared.width() != frame_width + 2 || passes_.prepared.height() != frame_height + 2) {
    passes_.prepared = DisplayImage(frame_width + 2, frame_height + 2, Display{0, 0, 0, 0});  // the border stays
    passes_.accumulation = Plane<float>(frame_width + 2, frame_height + 2);
  }
  passes_.lock_luma.fit(frame_width, frame_height);
  const DepthClip depth_clip(frame, passes_, output);
  for_rows(frame_height, [&](int y) {
    for (int x = 0; x < frame_width; ++x) {
      const Linear& c = frame.color(x, y);
      passes_.lock_luma(x, y) = lock_luma_of(c, passes_.exposure);
      const auto exposed = [&](float v) { return v > 0 ? std::min(v * passes_.exposure, 65504.0f) : 0.0f; };
      const float r = exposed(c.r), g = exposed(c.g), b = exposed(c.b);
      passes_.prepared(x + 1, y + 1) = {0.25f * r + 0.5f * g + 0.25f * b, 0.5f * r - 0.5f * b,
                                        -0.25f * r + 0.5f * g - 0.25f * b,
                                        options_.clips_depth ? depth_clip(x, y) : 0.0f};
      const float change = acceleration(passes_, last_motion, output, x, y);
      const float faster = change > 0 ? saturated(change - depth_divergence(passes_.dilated.depth, x, y)) : 0.0f;
      passes_.accumulation(x + 1, y + 1) = std::max(faster, motion_divergence(frame.motion, x, y));
    }
  });
  passes_.new_locks.fit(width_, height_);
  for_rows(height_, [&](int y) { std::ranges::fill(passes_.new_locks.row(y), 0.0f); });
  if (options_.locks) lock_thin_features(passes_.lock_luma, frame.jitter, passes_.new_locks);

  next_history_.fit(width_, height_), next_lumas_.fit(width_, height_);
  next_lock_life_.fit(width_, height_), next_lock_luma_.fit(width_, height_);
  rectify_and_blend(frame);
  std::swap(history_, next_history_), std::swap(lumas_, next_lumas_);
  std::swap(lock_life_, next_lock_life_), std::swap(lock_luma_, next_lock_luma_);
  last_motion_ = passes_.dilated.motion;

  return options_.sharpens ? sharpened(history_, passes_.exposure, options_.sharpness, 65504, std::move(memory))
                           : opaque(history_, std::move(memory));
}

void Fsr2::rectify_and_blend(const FsrFrame& frame) {
  const int frame_width = frame.color.width(), frame_height = frame.color.height();
  const SampleAxis columns(width_, frame_width, frame.jitter.x), rows(height_, frame_height, frame.jitter.y);
  const BilinearAxis jittered_columns(width_, frame_width, frame.jitter.x / static_cast<float>(frame_width));
  const BilinearAxis jittered_rows(height_, frame_height, frame.jitter.y / static_cast<float>(frame_height));
  const BilinearAxis block_columns(width_, passes_.luminance.width(), 0);
  const BilinearAxis block_rows(height_, passes_.luminance.height(), 0);
  const float ratio_x = static_cast<float>(frame_width) / static_cast<float>(width_);
  const float ratio_y = static_cast<float>(frame_height) / static_cast<float>(height_);
  const float area = 1 / (ratio_x * ratio_y);
  const bool is_first = frame.is_first || history_.empty();
  constexpr float mean_weight = 0.74f / 12;  // of a frame's samples at an output pixel
  const Fsr2AccumulateFrame common{
      .width = width_,
      .height = height_,
      .is_first = is_first,
      .rectifies = options_.rectifies,
      .has_lanczos = options_.has_lanczos,
      .exposure = passes_.exposure,
      .exposure_root = positive_power(passes_.exposure, 1.0f / 6),
      .kernel_max = std::min(1.99f, 1 / ratio_x),
      .box_scale = std::min(20.0f, area * area * area),
      .lock_decrease = 1 / (static_cast<float>(fsr_phases(frame_width, width_)) * mean_weight),
      .history = is_first ? nullptr : &history_.values().data()->r,
      .lumas = is_first ? nullptr : &lumas_.values().data()->r,
      .lock_life = is_first ? nullptr : lock_life_.values().data(),
      .lock_luma = is_first ? nullptr : lock_luma_.values().data()};
  std::vector<std::int32_t> pixel_columns[3];
  for (int k = 0; k < 3; ++k) pixel_columns[k] = scaled(columns.index[k], 4);
  // In the frame with its border.
  const std::vector<std::int32_t> mask_columns = scaled(jittered_columns.first, 1, 1);
  const std::vector<std::int32_t> clip_columns = scaled(mask_columns, 4);
  const std::vector<std::int32_t> motion_columns = scaled(columns.nearest, 2);
  for_rows(height_, [&](int o) {
    const auto i = static_cast<std::size_t>(o);
    const auto prepared = [&](int y) { return &passes_.prepared.row(y).data()->r; };
    const int first_row = jittered_rows.first[i] + 1;
    Fsr2AccumulateRow row{
        .clips = {prepared(first_row), prepared(first_row + 1)},
        .masks = {passes_.accumulation.row(first_row).data(), passes_.accumulation.row(first_row + 1).data()},
        .clip_column = clip_columns.data(),
        .mask_column = mask_columns.data(),
        .clip_right = jittered_columns.beyond.data(),
        .clip_below = jittered_rows.beyond[i],
        .motion = &passes_.dilated.motion.row(rows.nearest[i]).data()->x,
        .motion_column = motion_columns.data(),
        .luminances = {passes_.luminance.row(block_rows.first[i]).data(),
                       passes_.luminance.row(block_rows.second[i]).data()},
        .luminance_columns = {block_columns.first.data(), block_columns.second.data()},
        .luminance_right = block_columns.beyond.data(),
        .luminance_below = block_rows.beyond[i],
        .u = columns.centre.data(),
        .v = rows.centre[i],
        .new_locks = passes_.new_locks.row(o).data(),
        .history = &next_history_.row(o).data()->r,
        .lumas = &next_lumas_.row(o).data()->r,
        .lock_life = next_lock_life_.row(o).data(),
        .lock_luma = next_lock_luma_.row(o).data()};
    for (int k = 0; k < 3; ++k) {
      row.prepared[k] = prepared(rows.index[k][i]);
      row.columns[k] = pixel_columns[k].data();
      row.dx[k] = columns.offset[k].data(), row.dy[k] = rows.offset[k][i];
      row.is_column[k] = columns.is_inside[k].data(), row.is_row[k] = rows.is_inside[k][i];
    }
    Fsr2AccumulateKernels::of().accumulate_row(common, row, static_cast<std::size_t>(width_));
  });
}

}  // namespace zoneplate::upscale
