// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr2/fsr2_core.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/signal/samples.h"
#include "zoneplate/upscale/fsr1/rcas.h"
#include "zoneplate/upscale/fsr2/accumulate.h"

namespace zoneplate::upscale {
namespace {

constexpr int rows_a_block = 16;
constexpr float least_weight = 0.01f;  // of a bilinear sample of depth

template <class Body>
void for_rows(int height, const Body& body) {
  parallel_ranges(static_cast<std::size_t>(height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) body(y);
  });
}

float length(float x, float y) { return length(float2{x, y}); }
float saturated(float v) { return v > 0 ? std::min(v, 1.0f) : 0.0f; }
float luma709(const Linear& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }
float positive_power(float v, float exponent) { return v > 0 ? pow(v, exponent) : 0.0f; }

template <class T>
T at_clamped(const Plane<T>& plane, int x, int y) {
  return plane(std::clamp(x, 0, plane.width() - 1), std::clamp(y, 0, plane.height() - 1));
}
template <class T>
bool contains(const Plane<T>& plane, int x, int y) {
  return x >= 0 && y >= 0 && x < plane.width() && y < plane.height();
}

/// The four pixels around a position, in pixels from the centre of the first one, with their weights.
struct BilinearTaps {
  int x, y;
  float weight[4];

  BilinearTaps(float px, float py)
      : x(static_cast<int>(std::floor(px))), y(static_cast<int>(std::floor(py))), weight() {
    const float right = px - std::floor(px), below = py - std::floor(py);
    weight[0] = (1 - right) * (1 - below), weight[1] = right * (1 - below);
    weight[2] = (1 - right) * below, weight[3] = right * below;
  }
  template <class Use>
  void for_each(const Use& use) const {
    for (int k = 0; k < 4; ++k) use(x + k % 2, y + k / 2, weight[k]);
  }
};

/// The logarithm of the luminance at the unjittered centres.
Plane<float> log_luminances(const Fsr2Frame& frame) {
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

/// Means of 2 × 2 elements; beyond the plane there are zeros.
Plane<float> halved(const Plane<float>& plane) {
  Plane<float> out((plane.width() + 1) / 2, (plane.height() + 1) / 2);
  const auto value = [&](int x, int y) { return contains(plane, x, y) ? plane(x, y) : 0.0f; };
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      out(x, y) =
          (value(2 * x, 2 * y) + value(2 * x + 1, 2 * y) + value(2 * x, 2 * y + 1) + value(2 * x + 1, 2 * y + 1)) *
          0.25f;
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

/// The nearest depth of 3 × 3 pixels and the motion there, in widths and heights of the image, to the last frame.
void dilate(const Fsr2Frame& frame, Fsr2Passes& passes) {
  static constexpr int offsets[9][2] = {{0, 0}, {1, 0}, {0, 1}, {0, -1}, {-1, 0}, {-1, 1}, {1, 1}, {-1, -1}, {1, -1}};
  const int width = frame.depth.width(), height = frame.depth.height();
  passes.dilated_depth = Plane<float>(width, height), passes.dilated_motion = Plane<float2>(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      int nearest_x = x, nearest_y = y;
      for (const auto& [dx, dy] : offsets)
        if (contains(frame.depth, x + dx, y + dy) && frame.depth(x + dx, y + dy) < frame.depth(nearest_x, nearest_y))
          nearest_x = x + dx, nearest_y = y + dy;
      const float2 motion = frame.motion(nearest_x, nearest_y);
      passes.dilated_depth(x, y) = std::min(frame.depth(nearest_x, nearest_y), Fsr2::far);
      passes.dilated_motion(x, y) = {-motion.x / static_cast<float>(width), -motion.y / static_cast<float>(height)};
    }
  });
}

/// Where the frame's surfaces were in the last frame: every pixel that a surface touched gets the nearest depth.
Plane<float> previous_depth(const Fsr2Passes& passes, float2 output) {
  const int width = passes.dilated_depth.width(), height = passes.dilated_depth.height();
  Plane<float> out(width, height, Fsr2::far);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float2 motion = passes.dilated_motion(x, y);
      if (!(length(motion.x * output.x, motion.y * output.y) > 0.1f)) motion = {0, 0};
      const float px = static_cast<float>(x) + motion.x * static_cast<float>(width);
      const float py = static_cast<float>(y) + motion.y * static_cast<float>(height);
      if (!(px > -2 && py > -2 && px < static_cast<float>(width + 1) && py < static_cast<float>(height + 1))) continue;
      BilinearTaps(px, py).for_each([&](int i, int j, float w) {
        if (w > least_weight && contains(out, i, j)) out(i, j) = std::min(out(i, j), passes.dilated_depth(x, y));
      });
    }
  return out;
}

/// The share of a pixel that was hidden in the last frame.
class DepthClip {
 public:
  DepthClip(const Fsr2Frame& frame, const Fsr2Passes& passes, float2 output)
      : passes_(passes), previous_(passes.previous_depth), output_(output) {
    const auto width = static_cast<float>(previous_.width()), height = static_cast<float>(previous_.height());
    separation_ = 1.37e-5f * frame.corner * length(width, height);
    power_ = 1 + 2 * saturated(length(width, height) / length(1920.0f, 1080.0f));
  }

  float operator()(int x, int y) const {
    float2 motion = passes_.dilated_motion(x, y);
    if (!(length(motion.x * output_.x, motion.y * output_.y) > 0.01f)) motion = {0, 0};
    const float px = static_cast<float>(x) + motion.x * static_cast<float>(previous_.width());
    const float py = static_cast<float>(y) + motion.y * static_cast<float>(previous_.height());
    const bool is_near_image = px > -2 && py > -2 && px < static_cast<float>(previous_.width() + 1) &&
                               py < static_cast<float>(previous_.height() + 1);
    if (!is_near_image) return 0;
    const float depth = passes_.dilated_depth(x, y);
    float seen = 0, sum = 0;
    BilinearTaps(px, py).for_each([&](int i, int j, float w) {
      if (!contains(previous_, i, j) || !(w > least_weight)) return;
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
    const auto depth = [&](int row) { return contains(previous_, x, row) ? previous_(x, row) : Fsr2::far; };
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
  float greatest = length(own), least_agreement = 1;
  if (length(motion(x, y)) > 0.01f)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const float2 other = uv(at_clamped(motion, x + dx, y + dy));
        greatest = std::max(length(other), greatest);
        const float2 a{other.x / greatest, other.y / greatest}, b{own.x / greatest, own.y / greatest};
        least_agreement = std::min(least_agreement, a.x * b.x + a.y * b.y);
      }
  return saturated(1 - least_agreement) * saturated(greatest / 0.01f);
}

/// 1 - the least over the greatest depth of 3 × 3 pixels; beyond the frame depth is 0. 0 next to empty pixels.
float depth_divergence(const Plane<float>& depth, int x, int y) {
  float least = Fsr2::far, greatest = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const float d = contains(depth, x + dx, y + dy) ? depth(x + dx, y + dy) : 0.0f;
      if (d == Fsr2::far) return 0;
      least = std::min(least, d), greatest = std::max(greatest, d);
    }
  return 1 - least / greatest;
}

/// How much faster a surface moves than it did in the last frame.
float acceleration(const Fsr2Passes& passes, const Plane<float2>& last, float2 output, int x, int y) {
  const float2 motion = passes.dilated_motion(x, y);
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
Plane<float> find_locks(const Plane<float>& luma, float2 jitter, int width, int height) {
  Plane<float> out(width, height);
  for (int y = 0; y < luma.height(); ++y)
    for (int x = 0; x < luma.width(); ++x) {
      if (!is_thin_feature(luma, x, y)) continue;
      const auto place = [](int i, float shift, int from, int to) {
        const float centre = (static_cast<float>(i) + 0.5f - shift) / static_cast<float>(from);
        return static_cast<int>(std::floor(centre * static_cast<float>(to)));
      };
      const int i = place(x, jitter.x, luma.width(), width), j = place(y, jitter.y, luma.height(), height);
      if (contains(out, i, j)) out(i, j) = 1;
    }
  return out;
}

/// The samples around output pixels along one axis.
struct SampleAxis {
  std::vector<std::int32_t> index[3];  // in the frame with a border of one pixel
  std::vector<float> offset[3], is_inside[3];
  std::vector<std::int32_t> unjittered;  // likewise, of the pixel before the unjittered position
  std::vector<float> beyond;
  std::vector<std::int32_t> nearest;   // in the frame
  std::vector<std::int32_t> block[2];  // of 32 pixels
  std::vector<float> block_beyond, centre;

  SampleAxis(int to, int from, int blocks, float jitter) {
    const float step = static_cast<float>(from) / static_cast<float>(to);
    for (int o = 0; o < to; ++o) {
      const float place = (static_cast<float>(o) + 0.5f) * step, floored = std::floor(place);
      const float sample = floored + 0.5f - jitter;
      // The three samples nearest to the place, the nearest side first.
      const bool is_flipped = sample > place;
      for (int k = 0; k < 3; ++k) {
        const int away = is_flipped ? 1 - k : k - 1, pixel = static_cast<int>(floored) + away;
        index[k].push_back(pixel + 1);
        offset[k].push_back(sample - place + static_cast<float>(away));
        is_inside[k].push_back(pixel >= 0 && pixel < from ? 1.0f : 0.0f);
      }
      const float u = (static_cast<float>(o) + 0.5f) / static_cast<float>(to);
      centre.push_back(u);
      const auto clamped = [](float at, int size) {
        return std::clamp(at, 0.5f, static_cast<float>(size) - 0.5f) - 0.5f;
      };
      const float jittered = clamped((u + jitter / static_cast<float>(from)) * static_cast<float>(from), from);
      unjittered.push_back(static_cast<int>(std::floor(jittered)) + 1);
      beyond.push_back(jittered - std::floor(jittered));
      nearest.push_back(std::min(static_cast<int>(u * static_cast<float>(from)), from - 1));
      const float in_blocks = clamped(u * static_cast<float>(blocks), blocks);
      for (int k = 0; k < 2; ++k) block[k].push_back(std::min(static_cast<int>(std::floor(in_blocks)) + k, blocks - 1));
      block_beyond.push_back(in_blocks - std::floor(in_blocks));
    }
  }
  /// Indices times `floats`.
  static std::vector<std::int32_t> times(std::vector<std::int32_t> list, int floats) {
    for (std::int32_t& i : list) i *= floats;
    return list;
  }
};

}  // namespace

int Fsr2::phases(int frame_width, int width) {
  const float ratio = static_cast<float>(width) / static_cast<float>(frame_width);
  return std::max(static_cast<int>(8 * (ratio * ratio)), 1);
}

float2 Fsr2::jitter(int index, int phases) {
  const auto halton = [](int i, int base) {
    double f = 1, result = 0;
    for (; i > 0; i /= base) f /= base, result += f * (i % base);
    return result;
  };
  const auto rounded = [](double v) { return static_cast<float>(std::floor((v - 0.5) * 256 + 0.5) / 256); };
  const int i = index % phases + 1;
  return {rounded(halton(i, 2)), rounded(halton(i, 3))};
}

LinearImage Fsr2::accumulate(const Fsr2Frame& frame) {
  const int frame_width = frame.color.width(), frame_height = frame.color.height();
  const float2 output{static_cast<float>(width_), static_cast<float>(height_)};
  const bool is_first = frame.is_first || history_.empty();
  const Plane<float2> none;
  const Plane<float2>& last_motion = is_first ? none : last_motion_;

  Pyramid pyramid = pyramid_of(log_luminances(frame));
  const float rate = 1 - exp(-options_.frame_seconds);
  log_luminance_ = is_first ? pyramid.mean : log_luminance_ + (pyramid.mean - log_luminance_) * rate;
  // The luminance that saturates a sensor of ISO 100, at an exposure for the mean: S = 100, K = 12.5, q = 0.65.
  const float automatic = 1 / (78.0f / (0.65f * 100) * (exp(log_luminance_) * 100 / 12.5f));
  passes_.exposure = options_.exposure > 0 ? options_.exposure : automatic;
  passes_.luminance = std::move(pyramid.blocks);

  dilate(frame, passes_);
  passes_.previous_depth = previous_depth(passes_, output);
  passes_.lock_luma = Plane<float>(frame_width, frame_height);
  passes_.prepared = DisplayImage(frame_width + 2, frame_height + 2, Display{0, 0, 0, 0});
  passes_.accumulation = Plane<float>(frame_width + 2, frame_height + 2);
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
      const float faster = change > 0 ? saturated(change - depth_divergence(passes_.dilated_depth, x, y)) : 0.0f;
      passes_.accumulation(x + 1, y + 1) = std::max(faster, motion_divergence(frame.motion, x, y));
    }
  });
  passes_.new_locks =
      options_.locks ? find_locks(passes_.lock_luma, frame.jitter, width_, height_) : Plane<float>(width_, height_);

  next_history_ = LinearImage(width_, height_), next_lumas_ = DisplayImage(width_, height_);
  next_lock_life_ = Plane<float>(width_, height_), next_lock_luma_ = Plane<float>(width_, height_);
  rectify_and_blend(frame);
  std::swap(history_, next_history_), std::swap(lumas_, next_lumas_);
  std::swap(lock_life_, next_lock_life_), std::swap(lock_luma_, next_lock_luma_);
  last_motion_ = passes_.dilated_motion;

  LinearImage out(width_, height_);
  if (!options_.sharpens) {
    for_rows(height_, [&](int y) {
      std::ranges::transform(history_.row(y), out.row(y).begin(), [](const Linear& c) {
        return Linear{c.r, c.g, c.b, 1};
      });
    });
    return out;
  }
  LinearImage exposed(width_ + 2, height_ + 2);
  for_rows(height_ + 2, [&](int y) {
    for (int x = 0; x < width_ + 2; ++x) {
      const Linear& c = at_clamped(history_, x - 1, y - 1);
      const auto value = [&](float v) { return std::clamp(v * passes_.exposure, 0.0f, 65504.0f); };
      exposed(x, y) = {value(c.r), value(c.g), value(c.b), 1};
    }
  });
  const RcasOptions rcas{.sharpness = exp2(2 * options_.sharpness - 2),
                         .limits_by_ring = true,
                         .is_unbounded = true,
                         .denoises = true,
                         .reciprocals = Reciprocals::Approximate};
  for_rows(height_, [&](int y) {
    const auto row = [&](int i) { return &exposed.row(y + i)[1].r; };
    RcasKernels::of().sharpen_row(row(0), row(1), row(2), rcas, &out.row(y).data()->r,
                                  static_cast<std::size_t>(width_));
    for (Linear& c : out.row(y)) c = {c.r / passes_.exposure, c.g / passes_.exposure, c.b / passes_.exposure, 1};
  });
  return out;
}

void Fsr2::rectify_and_blend(const Fsr2Frame& frame) {
  const int frame_width = frame.color.width(), frame_height = frame.color.height();
  const SampleAxis columns(width_, frame_width, passes_.luminance.width(), frame.jitter.x);
  const SampleAxis rows(height_, frame_height, passes_.luminance.height(), frame.jitter.y);
  const float ratio_x = static_cast<float>(frame_width) / static_cast<float>(width_);
  const float ratio_y = static_cast<float>(frame_height) / static_cast<float>(height_);
  const float area = 1 / (ratio_x * ratio_y);
  const bool is_first = frame.is_first || history_.empty();
  constexpr float mean_weight = 0.74f / 12;  // of a frame's samples at an output pixel
  const Fsr2AccumulateFrame common{.width = width_,
                                   .height = height_,
                                   .is_first = is_first,
                                   .rectifies = options_.rectifies,
                                   .exposure = passes_.exposure,
                                   .exposure_root = positive_power(passes_.exposure, 1.0f / 6),
                                   .kernel_max = std::min(1.99f, 1 / ratio_x),
                                   .box_scale = std::min(20.0f, area * area * area),
                                   .lock_decrease = 1 / (static_cast<float>(phases(frame_width, width_)) * mean_weight),
                                   .history = is_first ? nullptr : &history_.values().data()->r,
                                   .lumas = is_first ? nullptr : &lumas_.values().data()->r,
                                   .lock_life = is_first ? nullptr : lock_life_.values().data(),
                                   .lock_luma = is_first ? nullptr : lock_luma_.values().data()};
  std::vector<std::int32_t> pixel_columns[3];
  for (int k = 0; k < 3; ++k) pixel_columns[k] = SampleAxis::times(columns.index[k], 4);
  const std::vector<std::int32_t> clip_columns = SampleAxis::times(columns.unjittered, 4);
  const std::vector<std::int32_t> motion_columns = SampleAxis::times(columns.nearest, 2);
  for_rows(height_, [&](int o) {
    const auto i = static_cast<std::size_t>(o);
    const auto prepared = [&](int y) { return &passes_.prepared.row(y).data()->r; };
    const int first_row = rows.unjittered[i];
    Fsr2AccumulateRow row{
        .clips = {prepared(first_row), prepared(first_row + 1)},
        .masks = {passes_.accumulation.row(first_row).data(), passes_.accumulation.row(first_row + 1).data()},
        .clip_column = clip_columns.data(),
        .mask_column = columns.unjittered.data(),
        .clip_right = columns.beyond.data(),
        .clip_below = rows.beyond[i],
        .motion = &passes_.dilated_motion.row(rows.nearest[i]).data()->x,
        .motion_column = motion_columns.data(),
        .luminances = {passes_.luminance.row(rows.block[0][i]).data(), passes_.luminance.row(rows.block[1][i]).data()},
        .luminance_columns = {columns.block[0].data(), columns.block[1].data()},
        .luminance_right = columns.block_beyond.data(),
        .luminance_below = rows.block_beyond[i],
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
