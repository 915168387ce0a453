// SPDX-License-Identifier: Apache-2.0
// Snapdragon Game Super Resolution 2: jittered frames of fewer pixels, accumulated as in FSR 2, with a few tests. There
// are no locks, no memory of luma and no reprojection of depth: a depth edge counts as a disocclusion, and history is
// clamped to the colours of five samples, or of nine if the camera rests.
//
// Made for mobile GPUs, in the variant of two compute passes, which computes with compressed colours. (In the fragment
// shaders, which are the faster variant, the four lookups of depth name their corners from the bottom in a space whose
// rows begin at the top.) Weaknesses: motion is dilated at points at rest only, so that the outlines of moving objects
// do not take their history along; while the camera rests, 30 % of clamped history stays as it was, also where an
// object has left; one colour does not stay: codes of 11 bits are rounded down, and light is restored with a factor of
// 1 / (1.009 - greatest channel), which darkens it by 1 % and more.
//
// A crop renders the whole image, since motion may bring any pixel into it.
//
// Source: Qualcomm, snapdragon-gsr, sgsr/v2 (glsl_2_pass_cs), 2024; frame constants of Qualcomm's sample.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/signal/samples.h"
#include "zoneplate/upscale/jittered_frame.h"
#include "zoneplate/upscale/sgsr/sgsr2_core.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// The camera's projection to Vulkan's clip space, in which an infinite distance has the depth 1.
float4x4 sgsr2_projection(const Camera& camera, float aspect) {
  const float4x4 clip = camera.clip_from_camera(aspect);
  const float x = clip.column[0].x, y = -clip.column[1].y;
  if (camera.is_orthographic) {
    const float depth = camera.far - camera.near;
    return {
        {float4{x, 0, 0, 0}, float4{0, y, 0, 0}, float4{0, 0, -1 / depth, 0}, float4{0, 0, -camera.near / depth, 1}}};
  }
  return {{float4{x, 0, 0, 0}, float4{0, y, 0, 0}, float4{0, 0, -1, -1}, float4{0, 0, -camera.near, 0}}};
}

float sgsr2_depth(const Camera& camera, float distance) {
  if (distance == infinity) return 1;
  const float depth =
      camera.is_orthographic ? (distance - camera.near) / (camera.far - camera.near) : 1 - camera.near / distance;
  return std::clamp(depth, 0.0f, 1.0f);
}

class Sgsr2Method : public Resolver {
 public:
  Sgsr2Method(double scale, double bias) : scale_(scale), bias_(bias) {}

  bool has_history() const override { return true; }
  Request request(const FrameContext& context) override {
    context_ = context;
    // Elements of Halton's sequence around 0 are the jitters; samples lie at the centres minus them.
    static const SamplePattern halton = halton_sequence(Sgsr2::phases);
    const SamplePosition place = halton[static_cast<std::size_t>(context.index % Sgsr2::phases)];
    const auto mirrored = [](std::uint8_t v) { return static_cast<std::uint8_t>(std::min(256 - v, 255)); };
    sample_ = sample_of(context, {mirrored(place.x), mirrored(place.y)});
    Request request;
    request.samples = {sample_};
    request.planes.depth = request.planes.motion = true;
    request.frame = frame_ = frame_size(context, scale_);
    request.footprint = footprint_of(scale_, bias_);
    request.ends_in_light = true;
    request.settling_frames = Sgsr2::phases;
    return request;
  }

  LinearImage resolve(Frame& frame) override {
    const ImageExtent& image = context_.image;
    if (context_.is_first || !sgsr2_) sgsr2_.emplace(image.width, image.height);
    const Camera &camera = context_.camera, &last = context_.last_camera;
    const float aspect = aspect_of(context_);
    const float4x4 clip_from_world = sgsr2_projection(camera, aspect) * inverse(camera.world_from_camera);
    const float4x4 last_clip_from_world = sgsr2_projection(last, aspect) * inverse(last.world_from_camera);
    // The camera of given frames is not known: all of their motion counts as that of objects.
    const bool rests = context_.given
                           ? std::ranges::all_of(frame.motion.values(), [](float2 m) { return m == float2{}; })
                           : clip_from_world == last_clip_from_world;
    Sgsr2Frame input{.color = over_background(std::move(frame.color), frame.display, "sgsr2"),
                     .depth = std::move(frame.depth),
                     .motion_x = Plane<float>::unset(frame_.width, frame_.height),
                     .motion_y = Plane<float>::unset(frame_.width, frame_.height),
                     .jitter = {(128 - sample_.x) / 256.0f, (128 - sample_.y) / 256.0f},
                     .half_width = camera.is_orthographic ? 1.0f : 1 / camera.clip_from_camera(aspect).column[0].x,
                     .is_first = context_.is_first,
                     .is_camera_at_rest = rests};
    if (!rests)
      input.last_clip_from_clip = sgsr2_projection(last, aspect) *
                                  (inverse(last.world_from_camera) * camera.world_from_camera) *
                                  inverse(sgsr2_projection(camera, aspect));
    const antialias::CameraMotion camera_motion(context_, frame_.width, frame_.height);
    antialias::for_rows(frame_.height, [&](int y) {
      for (int x = 0; x < frame_.width; ++x) {
        float& depth = input.depth(x, y);
        const float2 own = frame.motion(x, y);
        const float2 of_rest = camera_motion.at(x + sample_.x / 256.0, y + sample_.y / 256.0, double{depth});
        static constexpr float tolerance = 1.0f / 256;  // of pixels
        const bool is_object =
            depth < infinity && std::max(std::abs(own.x - of_rest.x), std::abs(own.y - of_rest.y)) > tolerance;
        constexpr float none = std::numeric_limits<float>::quiet_NaN();
        input.motion_x(x, y) = is_object ? 2 * own.x / static_cast<float>(frame_.width) : none;
        input.motion_y(x, y) = is_object ? 2 * own.y / static_cast<float>(frame_.height) : none;
        depth = sgsr2_depth(camera, depth);
      }
    });
    return cropped(sgsr2_->accumulate(input, std::move(frame.memory)), image.crop);
  }

 private:
  double scale_, bias_;
  FrameContext context_;
  ImageExtent frame_;
  SamplePosition sample_;
  std::optional<Sgsr2> sgsr2_;
};

constexpr Param sgsr2_params[] = {scale_param, bias_param(0)};

}  // namespace

Upscaler sgsr2() {
  return {.name = "sgsr2",
          .summary = "Snapdragon Game Super Resolution 2: jittered frames, accumulated in two passes",
          .source = "Qualcomm 2024, snapdragon-gsr v2, two compute passes",
          .params = sgsr2_params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<Sgsr2Method>(s.number("scale"), s.number("bias"));
          }};
}

}  // namespace zoneplate::upscale
