// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/taau/sample_mean.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "zoneplate/antialias/temporal/resolve.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/upscale/scatter_rows.h"
#include "zoneplate/upscale/taau/taau_axis.h"

namespace zoneplate::upscale {
namespace {

/// The samples that count at most, by the sum of their weights: 190 frames at scale 2.
constexpr float max_samples = 64;
/// The same of a history that lies between pixels, and is filtered in every frame: a longer one is blurred more than it
/// is worth. In a slow pan of `panning-wires` over 72 frames 3 samples, or 9 frames at scale 2, have the highest PSNR.
constexpr float max_filtered_samples = 3, max_filtered_frames = 8;
/// The same of a history that follows the surface beside, which drags the colours behind it along.
constexpr float max_borrowed_samples = 1, max_borrowed_frames = 3;
/// The sum of the weights of a frame's samples is π / 2.29 per frame pixel.
constexpr float weight_of_frame = 1.372f;

void for_rows_of(int height, const std::function<void(int)>& body) {
  parallel_ranges(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
  });
}

std::vector<float> whole_numbers(int count) {
  std::vector<float> out(static_cast<std::size_t>(count));
  std::iota(out.begin(), out.end(), 0.0f);
  return out;
}

const float* floats_of(const LinearImage& image) { return &image.values().data()->r; }
float* floats_of(LinearImage& image, int y) { return &image.row(y).data()->r; }
const float* floats_of(const LinearImage& image, int y) { return &image.row(y).data()->r; }

/// Marks the 7 × 7 windows in which eight tenths of the changes have one sign: there the light has changed at once.
/// Jitter brings edges and thin things, of either sign, to fewer of a window's samples. Two pixels around a window are
/// marked too: there the new light may be one that the last frames had beside. Beyond the frame, its outermost pixels
/// go on.
Plane<float> restarts_of(const Plane<float>& change) {
  constexpr int radius = 3, side = 2 * radius + 1, enough = 40, marked = radius + 2;
  const int width = change.width(), height = change.height();
  // Sums over rectangles that begin at (0, 0) of the plane with a border; windows are named by their first pixel there,
  // which is three pixels before that of their middle in the frame.
  Plane<int> sums(width + side, height + side), windows(width + 1, height + 1);
  for (int y = 0; y + 1 < sums.height(); ++y)
    for (int x = 0; x + 1 < sums.width(); ++x) {
      const float own = change(std::clamp(x - radius, 0, width - 1), std::clamp(y - radius, 0, height - 1));
      sums(x + 1, y + 1) = static_cast<int>(own) + sums(x, y + 1) + sums(x + 1, y) - sums(x, y);
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int sum = sums(x + side, y + side) - sums(x, y + side) - sums(x + side, y) + sums(x, y);
      if (std::abs(sum) < enough) continue;
      const int left = std::max(x - marked, 0), right = std::min(x + marked + 1, width);
      const int top = std::max(y - marked, 0), bottom = std::min(y + marked + 1, height);
      ++windows(left, top), ++windows(right, bottom), --windows(right, top), --windows(left, bottom);
    }
  // The number of windows over each pixel is the sum of what begins and ends before it.
  Plane<float> out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (x > 0) windows(x, y) += windows(x - 1, y);
      if (y > 0) windows(x, y) += windows(x, y - 1);
      if (x > 0 && y > 0) windows(x, y) -= windows(x - 1, y - 1);
      out(x, y) = windows(x, y) > 0 ? 1.0f : 0.0f;
    }
  return out;
}

}  // namespace

/// The range of the motions that brought surfaces of each pixel of the last frame into this one: the least and the
/// greatest along x, and along y; and their greatest reversed depth, as of this frame. A pixel whose surfaces all went
/// out of sight has an empty range.
struct SampleMean::Motions {
  Plane<float> side[4], nearest;
  Plane<std::int32_t> source;  ///< memory of `find`

  Motions(int width, int height) : nearest(width, height), source(width, height) {
    for (Plane<float>& limits : side) limits = Plane<float>(width, height);
  }
  void find(const TaauInput& frame);
};

void SampleMean::Motions::find(const TaauInput& frame) {
  const int width = frame.motion_x.width(), height = frame.motion_x.height();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  // Which pixel of the last frame each pixel comes from, or -1.
  std::vector<RowRange> rows(static_cast<std::size_t>(height));
  for_rows_of(height, [&](int y) {
    RowRange& own = rows[static_cast<std::size_t>(y)];
    for (int x = 0; x < width; ++x) {
      const float from_x = std::floor(static_cast<float>(x) - frame.motion_x(x, y) + 0.5f);
      const float from_y = std::floor(static_cast<float>(y) - frame.motion_y(x, y) + 0.5f);
      std::int32_t& from = source(x, y);
      from = -1;
      if (!(from_x >= 0 && from_y >= 0 && from_x < static_cast<float>(width) && from_y < static_cast<float>(height)))
        continue;
      const int v = static_cast<int>(from_y);
      from = v * width + static_cast<int>(from_x);
      own.add(v);
    }
  });
  float *const low_x = side[0].values().data(), *const high_x = side[1].values().data();
  float *const low_y = side[2].values().data(), *const high_y = side[3].values().data();
  float* const near = nearest.values().data();
  const auto begin = [&](int first, int after) {
    const std::ptrdiff_t offset = std::ptrdiff_t{first} * width, size = std::ptrdiff_t{after - first} * width;
    for (float* const low : {low_x, low_y}) std::fill_n(low + offset, size, infinity);
    for (float* const high : {high_x, high_y, near}) std::fill_n(high + offset, size, -infinity);
  };
  scatter_rows(rows, begin, [&](int y, int first, int after) {
    const auto origin = static_cast<std::uint32_t>(first * width);
    const auto size = static_cast<std::uint32_t>((after - first) * width);
    const std::span<const std::int32_t> from = source.row(y);
    const std::span<const float> nearness = frame.nearness.row(y);
    const std::span<const float> motion_x = frame.motion_x.row(y), motion_y = frame.motion_y.row(y);
    for (std::size_t x = 0; x < from.size(); ++x) {
      const std::int32_t i = from[x];
      if (static_cast<std::uint32_t>(i) - origin >= size) continue;
      near[i] = std::max(near[i], nearness[x]);
      low_x[i] = std::min(low_x[i], motion_x[x]), high_x[i] = std::max(high_x[i], motion_x[x]);
      low_y[i] = std::min(low_y[i], motion_y[x]), high_y[i] = std::max(high_y[i], motion_y[x]);
    }
  });
}

/// What is known of a frame, kept for the next one of its size, since memory for each frame anew takes a fifth of the
/// time.
struct SampleMean::Work {
  LinearImage color;
  Followed followed;
  Boxes now, past;
  Motions moved;

  Work(int width, int height)
      : color(width, height), now(boxes(width, height)), past(boxes(width, height)), moved(width, height) {
    for (Plane<float>* const plane : {&followed.nearest, &followed.x, &followed.y, &followed.kept, &followed.borrowed,
                                      &followed.uncovered, &followed.steady, &followed.change})
      *plane = Plane<float>(width, height);
  }

 private:
  static Boxes boxes(int width, int height) {
    return {LinearImage(width, height), LinearImage(width, height), Plane<float>(width, height),
            Plane<float>(width, height)};
  }
};

SampleMean::SampleMean(int width, int height) : width_(width), height_(height) {
  for (Output* const output : {&past_, &next_})
    *output = {LinearImage::unset(width, height), Plane<float>::unset(width, height)};
}
SampleMean::~SampleMean() = default;

/// Widens the boxes of this frame by those of the last one where they hold too, and finds how much history counts.
void SampleMean::compute_kept(const TaauInput& frame, Work& work) const {
  const LinearImage& color = work.color;
  const Boxes& past = work.past;
  const Motions& moved = work.moved;
  Boxes& now = work.now;
  Followed& followed = work.followed;
  const int width = color.width(), height = color.height();
  const auto pixels = static_cast<std::size_t>(width);
  const std::vector<float> column = whole_numbers(width);
  for_rows_of(height, [&](int y) {
    CompareRow row{.color = floats_of(color, y),
                   .nearest = followed.nearest.row(y).data(),
                   .follow_x = followed.x.row(y).data(),
                   .follow_y = followed.y.row(y).data(),
                   .is_alike = now.alike.row(y).data(),
                   .column = column.data(),
                   .y = y,
                   .moved_nearest = moved.nearest.values().data(),
                   .past_alike = past.alike.values().data(),
                   .past_low = floats_of(past.low),
                   .past_high = floats_of(past.high),
                   .past_trend = past.trend.values().data(),
                   .width = width,
                   .height = height,
                   .history = floats_of(past_.image),
                   .history_width = width_,
                   .history_height = height_,
                   .scale = {static_cast<float>(width_) / static_cast<float>(width),
                             static_cast<float>(height_) / static_cast<float>(height)},
                   .sample = {0.5f - frame.jitter.x, 0.5f - frame.jitter.y},
                   .is_uncovered = followed.uncovered.row(y).data(),
                   .is_steady = followed.steady.row(y).data(),
                   .change = followed.change.row(y).data(),
                   .trend = now.trend.row(y).data()};
    for (int k = 0; k < 4; ++k) row.moved[k] = moved.side[k].values().data();
    SampleMeanKernels::of().compare(row, pixels);
  });
  const Plane<float> restarts = restarts_of(followed.change);
  for_rows_of(height, [&](int y) {
    const WidenRow row{.follow_x = followed.x.row(y).data(),
                       .follow_y = followed.y.row(y).data(),
                       .is_steady = followed.steady.row(y).data(),
                       .is_uncovered = followed.uncovered.row(y).data(),
                       .restarts = restarts.row(y).data(),
                       .column = column.data(),
                       .y = y,
                       .trend = now.trend.values().data(),
                       .past_low = floats_of(past.low),
                       .past_high = floats_of(past.high),
                       .width = width,
                       .height = height,
                       .low = floats_of(now.low, y),
                       .high = floats_of(now.high, y),
                       .kept = followed.kept.row(y).data()};
    SampleMeanKernels::of().widen(row, pixels);
  });
  // The trend of another light would let the next change pass.
  for (std::size_t i = 0; i < restarts.values().size(); ++i)
    if (restarts.values()[i] > 0) now.trend.values()[i] = 0;
}

void SampleMean::for_output_rows(
    const Known& known, const std::function<void(const SampleMeanFrame& frame, SampleMeanRow& row)>& body) const {
  const LinearImage& color = known.color;
  const float2 jitter = known.input.jitter;
  const TaauAxis columns(width_, color.width(), jitter.x), rows(height_, color.height(), jitter.y);
  const bool is_first = !has_history_;
  const float scale_x = static_cast<float>(width_) / static_cast<float>(color.width());
  const float scale_y = static_cast<float>(height_) / static_cast<float>(color.height());
  const float frame_weight = weight_of_frame / (scale_x * scale_y);
  const SampleMeanFrame common{.width = width_,
                               .height = height_,
                               .is_first = is_first,
                               .scale = {scale_x, scale_y},
                               .most = max_samples,
                               .max_filtered = std::max(max_filtered_samples, max_filtered_frames * frame_weight),
                               .max_borrowed = std::max(max_borrowed_samples, max_borrowed_frames * frame_weight),
                               .history = is_first ? nullptr : floats_of(past_.image),
                               .count = past_.count.values().data()};
  // exp(-2.29 d²), with d in output pixels: a Gaussian near to the Blackman-Harris window of Karis 2014, by axis. Where
  // all samples are farther than 4 pixels, at scales above 8, it is raised for all of them, so that it does not vanish.
  const auto weight = [](float offset, int k, float scale) {
    const auto square = [&](int at) {
      const float d = (static_cast<float>(at - 1) - offset) * scale;
      return d * d;
    };
    return exp(-2.29f * (square(k) - std::max(0.0f, std::min({square(0), square(1), square(2)}) - 16)));
  };
  std::vector<float> weights[3];
  for (int k = 0; k < 3; ++k)
    for (const float offset : columns.offset) weights[k].push_back(weight(offset, k, common.scale[0]));
  const std::vector<float> column = whole_numbers(width_);
  const Boxes& now = known.boxes;
  const Followed& followed = known.followed;
  for_rows_of(height_, [&](int y) {
    const auto i = static_cast<std::size_t>(y);
    const int middle = rows.around[1][i];
    SampleMeanRow row{.low = floats_of(now.low, middle),
                      .high = floats_of(now.high, middle),
                      .follow_x = followed.x.row(middle).data(),
                      .follow_y = followed.y.row(middle).data(),
                      .is_borrowed = followed.borrowed.row(middle).data(),
                      .kept = followed.kept.row(middle).data(),
                      .column = column.data(),
                      .y = y};
    for (int k = 0; k < 3; ++k) {
      row.color[k] = floats_of(color, rows.around[k][i]);
      row.columns[k] = columns.around[k].data(), row.weight_x[k] = weights[k].data();
      row.weight_y[k] = weight(rows.offset[i], k, common.scale[1]);
    }
    body(common, row);
  });
}

void SampleMean::resolve(const Known& known, Output& out) {
  for_output_rows(known, [&](const SampleMeanFrame& frame, SampleMeanRow& row) {
    row.resolved = floats_of(out.image, row.y), row.count = out.count.row(row.y).data();
    SampleMeanKernels::of().resolve(frame, row, static_cast<std::size_t>(width_));
  });
}

const LinearImage& SampleMean::accumulate(const TaauInput& frame) {
  const int width = frame.color.width(), height = frame.color.height();
  const auto pixels = static_cast<std::size_t>(width);
  if (frame.is_first || !work_) {
    has_history_ = false;
    work_ = std::make_unique<Work>(width, height);
  }
  Work& work = *work_;
  std::swap(work.now, work.past);
  for_rows_of(height, [&](int y) {
    antialias::TemporalKernels::of().limit(floats_of(frame.color, y), floats_of(work.color, y), pixels);
  });
  const std::vector<float> column = whole_numbers(width);
  for_rows_of(height, [&](int y) {
    const SurveyRow row{.color = floats_of(work.color),
                        .nearness = frame.nearness.values().data(),
                        .motion_x = frame.motion_x.values().data(),
                        .motion_y = frame.motion_y.values().data(),
                        .width = width,
                        .height = height,
                        .column = column.data(),
                        .y = y,
                        .low = floats_of(work.now.low, y),
                        .high = floats_of(work.now.high, y),
                        .nearest = work.followed.nearest.row(y).data(),
                        .follow_x = work.followed.x.row(y).data(),
                        .follow_y = work.followed.y.row(y).data(),
                        .is_alike = work.now.alike.row(y).data(),
                        .is_borrowed = work.followed.borrowed.row(y).data()};
    SampleMeanKernels::of().survey(row, pixels);
  });
  if (has_history_) {
    work.moved.find(frame);
    compute_kept(frame, work);
  }
  resolve({frame, work.color, work.now, work.followed}, next_);
  std::swap(past_, next_);
  has_history_ = true;
  return past_.image;
}

}  // namespace zoneplate::upscale
