// SPDX-License-Identifier: Apache-2.0
// FidelityFX Super Resolution 2.2: accumulates jittered frames of fewer pixels in an image of the full size. History is
// reprojected by motion, dropped where surfaces were hidden, clamped to the colours around, and kept where thin
// features are locked (fsr2_core.h).
//
// Without reactive masks, as an engine that gives none: colours that change without motion, of transparent surfaces or
// of moving light, arrive late. Weaknesses: the automatic exposure follows the top left of the frame, as AMD's does; a
// thin feature in motion loses its lock and is drawn by the samples of one frame; each pixel has one depth and one
// motion, so that surfaces behind transparent ones smear.
//
// A crop renders the whole image, since motion may bring any pixel into it.
//
// Source: AMD, FidelityFX-FSR2 2.2.1, 2022.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "zoneplate/upscale/fsr2/fsr2_core.h"
#include "zoneplate/upscale/jittered_frame.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

/// The length of the vector from the camera to the image's corner at depth 1.
float corner_of(const Camera& camera, float aspect) {
  if (camera.is_orthographic) return 1;
  const float4x4 clip = camera.clip_from_camera(aspect);
  const float x = 1 / clip.column[0].x, y = 1 / clip.column[1].y;
  return std::sqrt(1 + x * x + y * y);
}

class Fsr2Method : public Resolver {
 public:
  Fsr2Method(double scale, const Fsr2Options& options) : scale_(scale), options_(options) {}

  Request request(const FrameContext& context) override {
    context_ = context;
    frame_ = frame_size(context, scale_);
    const int phases = Fsr2::phases(frame_.width, context.image.width);
    const float2 jitter = Fsr2::jitter(context.index, phases);
    const auto position = [](float shift) {
      return static_cast<std::uint8_t>(std::min(128 - static_cast<int>(shift * 256), 255));
    };
    sample_ = sample_of(context, {position(jitter.x), position(jitter.y)});
    Request request;
    request.samples = {sample_};
    request.planes.depth = request.planes.motion = true;
    request.frame = frame_;
    request.footprint = 0.5f / static_cast<float>(scale_);  // AMD's recommendation: a level of detail finer by 1
    request.settling_frames = phases;
    return request;
  }

  LinearImage resolve(Frame& frame) override {
    const ImageExtent& image = context_.image;
    if (context_.is_first || !fsr2_) fsr2_.emplace(image.width, image.height, options_);
    const float aspect = static_cast<float>(image.width) / static_cast<float>(image.height);
    Fsr2Frame input{.jitter = {(128 - sample_.x) / 256.0f, (128 - sample_.y) / 256.0f},
                    .corner = corner_of(context_.camera, aspect),
                    .is_first = context_.is_first};
    complete_background(frame, context_, sample_, Fsr2::far);
    input.color = over_background(std::move(frame.color), frame.display, "fsr2");
    input.depth = std::move(frame.depth), input.motion = std::move(frame.motion);
    return cropped(fsr2_->accumulate(input), image.crop);
  }

 private:
  double scale_;
  Fsr2Options options_;
  FrameContext context_;
  ImageExtent frame_;
  SamplePosition sample_;
  std::optional<Fsr2> fsr2_;
};

constexpr std::string_view switches[] = {"off", "on"};
constexpr Param params[] = {
    scale_param,
    real_param("sharpness", "of the sharpening pass; 0: none", 0, 0, 1),
    real_param("exposure", "factor of the colours; 0: from the mean luminance", 0, 0, 1e6),
    {.name = "locks", .meaning = "thin features keep their history", .value = 1, .names = switches},
    {.name = "rectify", .meaning = "history is clamped to the colours around", .value = 1, .names = switches},
    {.name = "clip", .meaning = "surfaces that were hidden drop their history", .value = 1, .names = switches}};

}  // namespace

Upscaler fsr2() {
  return {.name = "fsr2",
          .summary = "FidelityFX Super Resolution 2.2: jittered frames, accumulated with locks and depth tests",
          .source = "AMD 2022, FidelityFX-FSR2 2.2.1",
          .params = params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            const auto is_on = [&](std::string_view name) { return s.chosen(name) == "on"; };
            const auto sharpness = static_cast<float>(s.number("sharpness"));
            return std::make_unique<Fsr2Method>(s.number("scale"),
                                                Fsr2Options{.sharpens = sharpness > 0,
                                                            .sharpness = sharpness,
                                                            .locks = is_on("locks"),
                                                            .rectifies = is_on("rectify"),
                                                            .clips_depth = is_on("clip"),
                                                            .exposure = static_cast<float>(s.number("exposure"))});
          }};
}

}  // namespace zoneplate::upscale
