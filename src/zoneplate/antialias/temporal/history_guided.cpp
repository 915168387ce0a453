// SPDX-License-Identifier: Apache-2.0
// Every pixel is a bilinear sample of this frame alone: of seventeen around its centre, the one whose colour is nearest
// to the result of the last frame there. History decides which sample is taken and never enters the image itself.
//
// The candidates are the sample at the pixel's centre and those of the standard pattern of 16; the history, moved along
// with the surface of the pixel and filtered by Catmull-Rom, is mixed with a sixteenth of the first. Where none of the
// 3 × 3 samples has a surface, the sample at the centre is taken.
//
// A ghost cannot outlive a frame, since every colour lies between those of 3 × 3 samples of the current frame.
// Weaknesses: it does not accumulate samples, so that details finer than them stay aliased and choose among few
// colours; every image is a bilinear filter of its frame, wider than a pixel.
//
// Source    Godot, pull request 121368 (open), taa_resolve.glsl of August 2026. There pixels of the background have no
//           motion; here they have that of the camera. The jitter is that of `taa`.
#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/antialias/temporal/guided_samples.h"
#include "zoneplate/antialias/temporal/jitter.h"
#include "zoneplate/antialias/temporal/resolve.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace history_guided_method {
namespace {

constexpr int border = TemporalRow::border;

constexpr Param params[] = {
    {.name = "length",
     .meaning = "number of Halton points before the jitter repeats",
     .value = 16,
     .low = 1,
     .high = 1024},
    {.name = "frames", .meaning = "frames that are rendered for a still image", .value = 32, .low = 2, .high = 4096},
};

/// The weights of a frame's samples, which are at `jitter` in their pixels, for bilinear samples around pixel centres.
GuidedSamples samples_for(SamplePosition jitter) {
  SamplePattern places = standard_pattern(16);
  places.insert(places.begin(), SamplePosition{});
  GuidedSamples out;
  for (std::size_t k = 0; k < places.size(); ++k) {
    // In 1/256 pixel from the frame's sample; -1 to 1 pixel.
    const int x = places[k].x - jitter.x, y = places[k].y - jitter.y;
    const int left = x < 0 ? -1 : 0, above = y < 0 ? -1 : 0;
    const float fx = static_cast<float>(x - 256 * left) / 256, fy = static_cast<float>(y - 256 * above) / 256;
    for (int i = 0; i < 4; ++i) {
      out.sample[k].pixel[i] = (left + i % 2 + 1) + 3 * (above + i / 2 + 1);
      out.sample[k].weight[i] = (i % 2 ? fx : 1 - fx) * (i / 2 ? fy : 1 - fy);
    }
  }
  return out;
}

class HistoryGuided : public Resolver {
 public:
  HistoryGuided(int length, int frames) : jitter_(jitter_pattern(JitterSequence::Halton, length)), frames_(frames) {}

  bool has_history() const override { return true; }
  Request request(const FrameContext& context) override {
    context_ = context;
    Request request;
    request.samples = {sample()};
    request.halo = Request::whole_image;
    request.settling_frames = frames_;
    request.ends_in_light = true;
    request.planes.depth = request.planes.object_id = request.planes.motion = true;
    return request;
  }

  LinearImage resolve(Frame& frame) override {
    const int width = frame.color.width(), height = frame.color.height();
    take_current(frame);
    std::vector<float> column(static_cast<std::size_t>(width));
    for (std::size_t x = 0; x < column.size(); ++x) column[x] = static_cast<float>(x);
    const GuidedSamples samples = samples_for(sample());
    Plane<float> next(width, 4 * height);
    for_rows(height, [&](int y) {
      const GuidedRow row{.color = colors_of(color_, y + border, border),
                          .nearness = nearness_.row(y + border).data() + border,
                          .stride = nearness_.width(),
                          .motion = {motion_[0].row(y).data(), motion_[1].row(y).data()},
                          .column = column.data(),
                          .y = y,
                          .width = width,
                          .height = height,
                          .history = colors_of(history_.empty() ? next : history_, 0, 0),
                          .is_first = context_.is_first || history_.empty(),
                          .resolved = {next.row(4 * y).data(), width}};
      GuidedKernels::of().resolve(row, samples, column.size());
      TemporalKernels::of().decode(colors_of(next, y, 0), row.color, &frame.color(0, y).r, false, &frame.color(0, y).r,
                                   column.size());
    });
    history_ = std::move(next);
    return std::move(frame.color);
  }

 private:
  static ColorPlanes<const float> colors_of(const Plane<float>& rows, int y, int margin) {
    return {rows.row(4 * y).data() + margin, std::ptrdiff_t{rows.width()}};
  }

  SamplePosition sample() const {
    if (context_.given && context_.given->sample) return *context_.given->sample;
    return jitter_[static_cast<std::size_t>(context_.index) % jitter_.size()];
  }

  /// Makes the planes of this frame; colours and depths continue beyond its sides.
  void take_current(const Frame& frame) {
    const int width = frame.color.width(), height = frame.color.height();
    const CameraMotion camera(context_, width, height);
    const double jitter_x = sample().x / 256.0, jitter_y = sample().y / 256.0;
    color_ = Plane<float>(width + 2 * border, 4 * (height + 2 * border));
    nearness_ = Plane<float>(width + 2 * border, height + 2 * border);
    for (Plane<float>& motion : motion_) motion = Plane<float>(width, height);
    const auto extend = [](std::span<float> row) {
      std::fill_n(row.begin(), border, row[border]);
      std::fill_n(row.end() - border, border, row[row.size() - border - 1]);
    };
    for_rows(height + 2 * border, [&](int row) {
      const int y = std::clamp(row - border, 0, height - 1);
      const ColorPlanes<float> color{color_.row(4 * row).data() + border, std::ptrdiff_t{color_.width()}};
      TemporalKernels::of().encode(&frame.color(0, y).r, false, color, static_cast<std::size_t>(width));
      for (int c = 0; c < 4; ++c) extend(color_.row(4 * row + c));
      std::ranges::copy(frame.reversed_depth.row(y), nearness_.row(row).begin() + border);
      extend(nearness_.row(row));
    });
    for_rows(height, [&](int y) {
      for (int x = 0; x < width; ++x) {
        const float2 motion = frame.object_id(x, y) != Frame::no_id
                                  ? frame.motion(x, y)
                                  : camera.at(x + jitter_x, y + jitter_y, frame.depth(x, y));
        motion_[0](x, y) = motion.x, motion_[1](x, y) = motion.y;
      }
    });
  }

  SamplePattern jitter_;
  int frames_;
  FrameContext context_;
  Plane<float> color_, nearness_, motion_[2];
  Plane<float> history_;  ///< ColorPlanes
};

}  // namespace
}  // namespace history_guided_method

Method history_guided() {
  return {.name = "history-guided",
          .summary = "of 17 bilinear samples of this frame, the one nearest to the last result",
          .source = "Godot, pull request 121368",
          .params = history_guided_method::params,
          .make = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<history_guided_method::HistoryGuided>(s.integer("length"), s.integer("frames"));
          },
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
