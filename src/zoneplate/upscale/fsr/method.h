// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "zoneplate/upscale/fsr/frame.h"
#include "zoneplate/upscale/jittered_frame.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {

/// The length of the vector from the camera to the image's corner at depth 1.
inline float corner_of(const Camera& camera, float aspect) {
  if (camera.is_orthographic) return 1;
  const float4x4 clip = camera.clip_from_camera(aspect);
  const float x = 1 / clip.column[0].x, y = 1 / clip.column[1].y;
  return std::sqrt(1 + x * x + y * y);
}

/// Textures with a level of detail that is finer by 1 than the image's pixels require, as AMD recommends.
inline constexpr Param fsr_bias_param = bias_param(-1);

/// The resolver of FSR 2 or FSR 3: asks for frames jittered by their sequence, and accumulates them in a `Core`, which
/// has the constructor Core(width, height, options) and accumulate(frame).
template <class Core, class Options>
class FsrMethod : public Resolver {
 public:
  FsrMethod(std::string_view name, const Settings& settings, const Options& options)
      : name_(name), scale_(settings.number("scale")), bias_(settings.number("bias")), options_(options) {}

  bool has_history() const override { return true; }
  Request request(const FrameContext& context) override {
    context_ = context;
    frame_ = frame_size(context, scale_);
    const int phases = fsr_phases(frame_.width, context.image.width);
    const float2 jitter = fsr_jitter(context.index, phases);
    const auto position = [](float shift) {
      return static_cast<std::uint8_t>(std::min(128 - static_cast<int>(shift * 256), 255));
    };
    sample_ = sample_of(context, {position(jitter.x), position(jitter.y)});
    Request request;
    request.samples = {sample_};
    request.planes.depth = request.planes.motion = true;
    request.frame = frame_;
    request.footprint = footprint_of(scale_, bias_);
    request.ends_in_light = true;
    request.settling_frames = phases;
    return request;
  }

  LinearImage resolve(Frame& frame) override {
    const ImageExtent& image = context_.image;
    if (context_.is_first || !core_) core_.emplace(image.width, image.height, options_);
    FsrFrame input{.jitter = {(128 - sample_.x) / 256.0f, (128 - sample_.y) / 256.0f},
                   .corner = corner_of(context_.camera, aspect_of(context_)),
                   .is_first = context_.is_first};
    complete_background(frame, context_, sample_, FsrFrame::far);
    input.color = over_background(std::move(frame.color), frame.display, name_);
    input.depth = std::move(frame.depth), input.motion = std::move(frame.motion);
    return cropped(core_->accumulate(input, std::move(frame.memory)), image.crop);
  }

 private:
  std::string_view name_;
  double scale_, bias_;
  Options options_;
  FrameContext context_;
  ImageExtent frame_;
  SamplePosition sample_;
  std::optional<Core> core_;
};

}  // namespace zoneplate::upscale
