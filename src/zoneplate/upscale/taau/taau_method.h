// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/signal/samples.h"
#include "zoneplate/upscale/jittered_frame.h"
#include "zoneplate/upscale/taau/taau_core.h"

namespace zoneplate::upscale {

/// Requests jittered frames, and accumulates them in a `Core`, as Taau. `Core::grain` is the number of pixels of its
/// history per output pixel, along one axis.
template <class Core>
class TaauMethod : public Resolver {
 public:
  /// `name` is for messages.
  TaauMethod(std::string_view name, double scale, double bias)
      : name_(name), scale_(scale), bias_(bias), jitter_(halton_sequence(phases(Core::grain * scale))) {}

  bool has_history() const override { return true; }
  Request request(const FrameContext& context) override {
    context_ = context;
    sample_ = sample_of(context, jitter_[static_cast<std::size_t>(context.index) % jitter_.size()]);
    Request request;
    request.samples = {sample_};
    request.planes.depth = request.planes.motion = true;
    request.frame = frame_size(context, scale_);
    request.footprint = footprint_of(scale_, bias_);
    request.ends_in_light = true;
    request.settling_frames = Core::settling_periods * static_cast<int>(jitter_.size());
    return request;
  }

  LinearImage resolve(Frame& frame) override {
    const ImageExtent& image = context_.image;
    if (context_.is_first || !core_) core_.emplace(image.width, image.height);
    complete_background(frame, context_, sample_, std::numeric_limits<float>::infinity());
    const int width = frame.color.width(), height = frame.color.height();
    TaauInput input{.color = over_background(std::move(frame.color), frame.display, name_),
                    .nearness = std::move(frame.reversed_depth),
                    .motion_x = Plane<float>::unset(width, height),
                    .motion_y = Plane<float>::unset(width, height),
                    .jitter = {(128 - sample_.x) / 256.0f, (128 - sample_.y) / 256.0f},
                    .is_first = context_.is_first};
    antialias::for_rows(height, [&](int y) {
      std::ranges::transform(frame.motion.row(y), input.motion_x.row(y).begin(), &float2::x);
      std::ranges::transform(frame.motion.row(y), input.motion_y.row(y).begin(), &float2::y);
    });
    if constexpr (requires { core_->accumulate(input, LinearImage()); })
      return cropped(core_->accumulate(input, std::move(frame.memory)), image.crop);
    else
      return cropped(core_->accumulate(input), image.crop, std::move(frame.memory));
  }

 private:
  /// 8 samples per pixel of the history.
  static int phases(double scale) { return std::max(static_cast<int>(8 * scale * scale), 1); }

  std::string_view name_;
  double scale_, bias_;
  SamplePattern jitter_;
  FrameContext context_;
  SamplePosition sample_;
  std::optional<Core> core_;
};

}  // namespace zoneplate::upscale
