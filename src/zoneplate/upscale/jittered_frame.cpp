// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/jittered_frame.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/base/error.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

/// The scene-linear colour that becomes `light` on the display, or one that comes near to it, where the curve does not
/// reach it.
float3 scene_light(float3 light, const DisplayOptions& display) {
  const ToneMapping mapping = display.raw ? ToneMapping::None : display.mapping;
  const float scale = 1 / display.exposure;
  if (mapping == ToneMapping::None) return light * scale;
  if (mapping == ToneMapping::Neutral) return invert_neutral(light) * scale;
  // The curves rise with each channel and mix channels little: half of the ratio, as a logarithm, is a stable step.
  constexpr float least = 1e-6f, most = 1024;
  float3 color = light;
  for (int step = 0; step < 200; ++step) {
    const float3 mapped = tone_map(color, mapping);
    const auto nearer = [&](float value, float is, float to) {
      return std::clamp(std::max(value, least) * std::sqrt((to + least) / (is + least)), 0.0f, most);
    };
    color = {nearer(color.x, mapped.x, light.x), nearer(color.y, mapped.y, light.y),
             nearer(color.z, mapped.z, light.z)};
  }
  return color * scale;
}

}  // namespace

ImageExtent frame_size(const FrameContext& context, double scale) {
  if (const auto& given = context.given) return {given->width, given->height, std::nullopt};
  return zoneplate::frame_size(context.image, scale);
}

float footprint_of(double scale, double bias) { return exp2(static_cast<float>(bias)) / static_cast<float>(scale); }

SamplePosition sample_of(const FrameContext& context, SamplePosition planned) {
  return context.given && context.given->sample ? *context.given->sample : planned;
}

LinearImage over_background(LinearImage image, const DisplayOptions& display, std::string_view name) {
  if (display.is_transparent)
    throw Error(ErrorKind::Usage, std::string(name) + " makes opaque images, and this one is not: give a --background");
  const auto light = [&](float code) { return display.raw ? code : decode_srgb(code); };
  const float4 b = display.background;
  const float3 color = scene_light({light(b.x), light(b.y), light(b.z)}, display);
  const Linear background{color.x * b.w, color.y * b.w, color.z * b.w, b.w};
  antialias::for_rows(image.height(), [&](int y) {
    for (Linear& c : image.row(y)) c = c + background * (1 - c.a);
  });
  return image;
}

void complete_background(Frame& frame, const FrameContext& context, SamplePosition sample, float far) {
  const antialias::CameraMotion camera(context, frame.depth.width(), frame.depth.height());
  antialias::for_rows(frame.depth.height(), [&](int y) {
    for (int x = 0; x < frame.depth.width(); ++x)
      if (float& depth = frame.depth(x, y); !(depth < far)) {
        frame.motion(x, y) = camera.at(x + sample.x / 256.0, y + sample.y / 256.0, double{depth});
        depth = far;
      }
  });
}

LinearImage cropped(const LinearImage& image, const std::optional<Crop>& crop, LinearImage memory) {
  const Crop part = crop.value_or(Crop{0, 0, image.width(), image.height()});
  LinearImage out = std::move(memory);
  out.fit(part.width, part.height);
  antialias::for_rows(
      part.height, [&](int y) { std::copy_n(image.row(part.y + y).begin() + part.x, part.width, out.row(y).begin()); });
  return out;
}

LinearImage cropped(LinearImage&& image, const std::optional<Crop>& crop) {
  return crop ? cropped(std::as_const(image), crop) : std::move(image);
}

}  // namespace zoneplate::upscale
