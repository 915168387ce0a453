// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr3/fsr3_core.h"

#include <limits>
#include <utility>
#include <vector>

#include "zoneplate/math/elementary.h"
#include "zoneplate/upscale/fsr/sample_axis.h"
#include "zoneplate/upscale/fsr3/accumulate.h"
#include "zoneplate/upscale/fsr3/prepare.h"

namespace zoneplate::upscale {
namespace {

using namespace fsr;

constexpr float max_half = fsr3_greatest_half;
constexpr int tile = 64;  // pixels along a side of the squares that the mean luminance has as a last full level

/// The mean of the square of the greatest power of two within the longer side, from the top left. Edge pixels continue
/// the frame to whole tiles; of larger squares, the parts that no whole tile covers count as 0.
float mean_from_top_left(const Plane<float>& plane) {
  int levels = 0;
  while (2 << levels <= std::max(plane.width(), plane.height())) ++levels;
  if (levels == 0) return plane(0, 0);
  const auto in_tiles = [](int size) { return (size + tile - 1) / tile * tile; };
  Plane<float> level(in_tiles(plane.width()) / 2, in_tiles(plane.height()) / 2);
  for_rows(level.height(), [&](int y) {
    for (int x = 0; x < level.width(); ++x) {
      const auto at = [&](int i, int j) { return at_clamped(plane, 2 * x + i, 2 * y + j); };
      level(x, y) = (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) * 0.25f;
    }
  });
  for (int k = 2; k <= levels; ++k) {
    if (k == 7) {
      Plane<float> whole(std::max(1, plane.width() / tile), std::max(1, plane.height() / tile));
      for (int y = 0; y < whole.height(); ++y) std::copy_n(level.row(y).begin(), whole.width(), whole.row(y).begin());
      level = std::move(whole);
    }
    level = halved(level);
  }
  return level(0, 0);
}

/// Half of a side, at least 1.
int half(int size) { return std::max(1, size / 2); }

/// Means of 2 × 2 elements of value(x, y); odd rows and columns at the end are left out.
template <class Value>
Plane<float> means(int width, int height, const Value& value) {
  Plane<float> out(half(width), half(height));
  for_rows(out.height(), [&](int y) {
    const int below = std::min(2 * y + 1, height - 1);
    for (int x = 0; x < out.width(); ++x) {
      const int right = std::min(2 * x + 1, width - 1);
      out(x, y) = (value(2 * x, 2 * y) + value(right, 2 * y) + value(2 * x, below) + value(right, below)) * 0.25f;
    }
  });
  return out;
}

/// The change of shading of blocks of 2 × 2 pixels: of three levels of means, the greatest product of the mean
/// difference and the mean sign, which is small where differences cancel.
Plane<float> shading_changes(const Plane<float>& differences, float2 jitter) {
  const int width = differences.width(), height = differences.height();
  Plane<float> out(half(width), half(height));
  Plane<float> mean = means(width, height, [&](int x, int y) { return differences(x, y); });
  Plane<float> sign = means(width, height, [&](int x, int y) {
    const float d = differences(x, y);
    return d > 0 ? 1.0f : d < 0 ? -1.0f : 0.0f;
  });
  for (int level = 0; level < 3; ++level) {
    if (level > 0) {
      const Plane<float> finer = std::move(mean), finer_sign = std::move(sign);
      const int w = finer.width(), h = finer.height();
      mean = means(w, h, [&](int x, int y) { return finer(x, y); });
      sign = means(w, h, [&](int x, int y) { return finer_sign(x, y); });
    }
    const BilinearAxis columns(out.width(), mean.width(), jitter.x / static_cast<float>(width));
    const BilinearAxis rows(out.height(), mean.height(), jitter.y / static_cast<float>(height));
    for_rows(out.height(), [&](int y) {
      const auto j = static_cast<std::size_t>(y);
      for (int x = 0; x < out.width(); ++x) {
        const auto i = static_cast<std::size_t>(x);
        const auto sample = [&](const Plane<float>& plane) {
          const auto across = [&](int row) {
            const float left = plane(columns.first[i], row), right = plane(columns.second[i], row);
            return left + (right - left) * columns.beyond[i];
          };
          const float above = across(rows.first[j]), below = across(rows.second[j]);
          return above + (below - above) * rows.beyond[j];
        };
        out(x, y) = std::max(out(x, y), std::abs(sample(mean) * sample(sign)));
      }
    });
  }
  for_rows(out.height(), [&](int y) {
    for (float& v : out.row(y)) v = std::floor(saturated(v) * 255 + 0.5f) / 255;
  });
  return out;
}

/// The positions of output pixels in a plane, from which Fsr3Between of each row is made.
class Positions {
 public:
  Positions(int width, int height, const Plane<float>& plane, float2 shift)
      : Positions(width, height, plane.width(), plane.height(), shift, 1) {
    first_ = plane.values().data();
  }
  Positions(int width, int height, const DisplayImage& plane, float2 shift)
      : Positions(width, height, plane.width(), plane.height(), shift, 4) {
    first_ = &plane.values().data()->r;
  }
  Fsr3Between row(int y) const {
    const auto j = static_cast<std::size_t>(y);
    const auto at = [&](int row) { return first_ + static_cast<std::size_t>(row) * stride_; };
    return {.rows = {at(rows_.first[j]), at(rows_.second[j])},
            .columns = {left_.data(), right_.data()},
            .right = columns_.beyond.data(),
            .below = rows_.beyond[j]};
  }

 private:
  Positions(int to_width, int to_height, int width, int height, float2 shift, int floats)
      : columns_(to_width, width, shift.x),
        rows_(to_height, height, shift.y),
        left_(scaled(columns_.first, floats)),
        right_(scaled(columns_.second, floats)),
        stride_(static_cast<std::size_t>(width) * static_cast<std::size_t>(floats)) {}

  BilinearAxis columns_, rows_;
  std::vector<std::int32_t> left_, right_;
  std::size_t stride_;
  const float* first_ = nullptr;
};

/// The contrasts of thin features, at the output pixels that contain their samples.
void place_locks(const Plane<float>& confidence, float2 jitter, Plane<float>& out) {
  const auto place = [](int i, float shift, int from, int to) {
    const float centre = (static_cast<float>(i) + 0.5f - shift) / static_cast<float>(from);
    return static_cast<int>(std::floor(centre * static_cast<float>(to)));
  };
  for (int y = 0; y < confidence.height(); ++y) {
    const int row = place(y, jitter.y, confidence.height(), out.height());
    for (int x = 0; x < confidence.width(); ++x) {
      if (!(confidence(x, y) > 0.01f)) continue;
      const int column = place(x, jitter.x, confidence.width(), out.width());
      if (contains(out, column, row)) out(column, row) = std::floor(confidence(x, y) * 255 + 0.5f) / 255;
    }
  }
}

}  // namespace

void Fsr3::forget(int frame_width, int frame_height) {
  log_luminance_ = 1;  // as AMD's, from which the exposure adapts to the first frame too
  last_jitter_ = {0, 0};
  last_luma_ = accumulation_ = Plane<float>(frame_width, frame_height);
  luma_history_ = DisplayImage(frame_width, frame_height, Display{0, 0, 0, 0});
}

LinearImage Fsr3::accumulate(const FsrFrame& frame, LinearImage memory) {
  is_first_ = frame.is_first || history_.empty();
  if (is_first_) forget(frame.color.width(), frame.color.height());
  prepare(frame);
  next_history_.fit(width_, height_);
  upsample(frame);
  std::swap(history_, next_history_), std::swap(accumulation_, next_accumulation_);
  std::swap(luma_history_, next_luma_history_);
  last_luma_ = passes_.luma, last_jitter_ = frame.jitter;
  return options_.sharpens ? sharpened(history_, passes_.exposure, options_.sharpness, max_half, std::move(memory))
                           : opaque(history_, std::move(memory));
}

void Fsr3::prepare(const FsrFrame& frame) {
  const int width = frame.color.width(), height = frame.color.height();
  const auto& kernels = Fsr3PrepareKernels::of();

  passes_.luma.fit(width, height);
  auto logarithms = Plane<float>::unset(width, height);
  for_rows(height, [&](int y) {
    kernels.luma_row(&frame.color.row(y).data()->r, passes_.luma.row(y).data(), logarithms.row(y).data(),
                     static_cast<std::size_t>(width));
  });
  const float rate = 1 - exp(-options_.frame_seconds);
  log_luminance_ = std::max(0.0f, log_luminance_ + (mean_from_top_left(logarithms) - log_luminance_) * rate);
  passes_.exposure = options_.exposure > 0 ? options_.exposure : automatic_exposure(log_luminance_);

  const float min_weight = 10 * fsr3_epsilon;
  dilate(frame, passes_.dilated);
  passes_.previous_depth = previous_depth(passes_.dilated, min_weight, [](float2 motion, float depth) {
    const float far = saturated(std::min(depth, max_half) / 100);
    return length(float2{motion.x * 3840, motion.y * 2160}) > 0.25f + 0.5f * far;
  });
  passes_.farthest_depth = means(width, height, [&](int x, int y) { return std::min(frame.depth(x, y), max_half); });

  std::vector<float> u;
  for (int x = 0; x < width; ++x) u.push_back((static_cast<float>(x) + 0.5f) / static_cast<float>(width));
  const float2 diagonal{static_cast<float>(width) * 0.5f, static_cast<float>(height) * 0.5f};
  const Fsr3PrepareFrame common{
      .width = width,
      .height = height,
      .exposure = passes_.exposure,
      .jitter_x = frame.jitter.x,
      .jitter_y = frame.jitter.y,
      .last_jitter_x = last_jitter_.x,
      .last_jitter_y = last_jitter_.y,
      .separation = options_.clips_depth ? 1.37e-5f * length(diagonal) : std::numeric_limits<float>::max(),
      .u = u.data(),
      .luma = passes_.luma.values().data(),
      .depth = passes_.dilated.depth.values().data(),
      .motion = &passes_.dilated.motion.values().data()->x,
      .previous_depth = passes_.previous_depth.values().data(),
      .last_luma = last_luma_.values().data(),
      .accumulation = accumulation_.values().data(),
      .luma_history = &luma_history_.values().data()->r};

  passes_.differences = Plane<float>(width, height);
  if (options_.tests_shading)
    for_rows(height, [&](int y) { kernels.difference_row(common, y, passes_.differences.row(y).data()); });
  passes_.shading_change = shading_changes(passes_.differences, frame.jitter);

  const float2 shift{frame.jitter.x / static_cast<float>(width), frame.jitter.y / static_cast<float>(height)};
  passes_.masks.fit(width, height);
  next_accumulation_.fit(width, height), passes_.instability.fit(width, height);
  auto confidence = Plane<float>::unset(width, height);
  const Positions unjittered(width, height, passes_.shading_change, {-shift.x, -shift.y});
  for_rows(height, [&](int y) {
    kernels.reactivity_row(common, y, unjittered.row(y), &passes_.masks.row(y).data()->r,
                           next_accumulation_.row(y).data(), confidence.row(y).data());
  });
  passes_.new_locks.fit(width_, height_);
  for_rows(height_, [&](int y) { std::ranges::fill(passes_.new_locks.row(y), 0.0f); });
  if (options_.locks) place_locks(confidence, frame.jitter, passes_.new_locks);

  next_luma_history_.fit(width, height);
  const Positions masks(width, height, passes_.masks, shift), lumas(width, height, passes_.luma, shift);
  for_rows(height, [&](int y) {
    kernels.instability_row(common, y, masks.row(y), lumas.row(y), &next_luma_history_.row(y).data()->r,
                            passes_.instability.row(y).data());
  });
}

void Fsr3::upsample(const FsrFrame& frame) {
  const int frame_width = frame.color.width(), frame_height = frame.color.height();

  // The exposed colours with a border that continues them, and below them the tone-mapped ones.
  auto prepared = DisplayImage::unset(frame_width + 2, 2 * (frame_height + 2));
  for_rows(frame_height + 2, [&](int y) {
    for (int x = 0; x < frame_width + 2; ++x) {
      const Linear& c = at_clamped(frame.color, x - 1, y - 1);
      const auto exposed = [&](float v) { return v > 0 ? v * passes_.exposure : 0.0f; };
      const float r = exposed(c.r), g = exposed(c.g), b = exposed(c.b), scale = 1 / (std::max({r, g, b}) + 1);
      const auto ycocg = [](float red, float green, float blue) {
        return Display{0.25f * red + 0.5f * green + 0.25f * blue, 0.5f * red - 0.5f * blue,
                       -0.25f * red + 0.5f * green - 0.25f * blue, 0};
      };
      prepared(x, y) = ycocg(r, g, b);
      prepared(x, y + frame_height + 2) = ycocg(r * scale, g * scale, b * scale);
    }
  });

  const SampleAxis columns(width_, frame_width, frame.jitter.x), rows(height_, frame_height, frame.jitter.y);
  std::vector<std::int32_t> pixel_columns[3];
  std::vector<float> box_x[3];
  const auto box = [](float offset, float is_inside) { return exp(-2.3f * (offset * offset)) * is_inside; };
  for (int k = 0; k < 3; ++k) {
    pixel_columns[k] = scaled(columns.index[k], 4);
    for (std::size_t i = 0; i < columns.offset[k].size(); ++i)
      box_x[k].push_back(box(columns.offset[k][i], columns.is_inside[k][i]));
  }
  const std::vector<std::int32_t> motion_columns = scaled(columns.nearest, 2);
  const float2 shift{frame.jitter.x / static_cast<float>(frame_width),
                     frame.jitter.y / static_cast<float>(frame_height)};
  const Positions masks(width_, height_, passes_.masks, shift);
  const Positions instability(width_, height_, passes_.instability, {0, 0});
  const Positions farthest(width_, height_, passes_.farthest_depth, shift);

  const float ratio = static_cast<float>(frame_width) / static_cast<float>(width_);
  const Fsr3AccumulateFrame common{.width = width_,
                                   .height = height_,
                                   .is_first = is_first_,
                                   .rectifies = options_.rectifies,
                                   .exposure = passes_.exposure,
                                   .kernel_max = std::min(1.99f, 1 / ratio),
                                   .lock_decrease = 0.1f / static_cast<float>(fsr_phases(frame_width, width_)),
                                   .velocity_factor = options_.velocity_factor,
                                   .tone_mapped = 4 * (frame_width + 2) * (frame_height + 2),
                                   .history = is_first_ ? nullptr : &history_.values().data()->r};
  for_rows(height_, [&](int o) {
    const auto i = static_cast<std::size_t>(o);
    Fsr3AccumulateRow row{.masks = masks.row(o),
                          .instability = instability.row(o),
                          .farthest_depth = farthest.row(o),
                          .motion = &passes_.dilated.motion.row(rows.nearest[i]).data()->x,
                          .motion_column = motion_columns.data(),
                          .u = columns.centre.data(),
                          .v = rows.centre[i],
                          .new_locks = passes_.new_locks.row(o).data(),
                          .history = &next_history_.row(o).data()->r};
    for (int k = 0; k < 3; ++k) {
      row.prepared[k] = &prepared.row(rows.index[k][i]).data()->r;
      row.columns[k] = pixel_columns[k].data();
      row.dx[k] = columns.offset[k].data(), row.dy[k] = rows.offset[k][i];
      row.is_column[k] = columns.is_inside[k].data(), row.is_row[k] = rows.is_inside[k][i];
      row.box_x[k] = box_x[k].data(), row.box_y[k] = box(rows.offset[k][i], rows.is_inside[k][i]);
    }
    Fsr3AccumulateKernels::of().accumulate_row(common, row, static_cast<std::size_t>(width_));
  });
}

}  // namespace zoneplate::upscale
