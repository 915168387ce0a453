// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/jittered_frame.h"

#include <algorithm>
#include <string>

#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/base/error.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {

ImageExtent frame_size(const FrameContext& context, double scale) {
  if (const auto& given = context.given) return {given->width, given->height, std::nullopt};
  return frame_size(context.image, scale);
}

SamplePosition sample_of(const FrameContext& context, SamplePosition planned) {
  return context.given && context.given->sample ? *context.given->sample : planned;
}

LinearImage over_background(LinearImage image, const DisplayOptions& display, std::string_view name) {
  if (display.is_transparent)
    throw Error(ErrorKind::Usage,
                std::string(name) + " makes opaque images, and a transparent background is requested");
  const auto light = [&](float code) { return (display.raw ? code : decode_srgb(code)) / display.exposure; };
  const float4 b = display.background;
  const Linear background{light(b.x) * b.w, light(b.y) * b.w, light(b.z) * b.w, b.w};
  for (Linear& c : image.values()) c = c + background * (1 - c.a);
  return image;
}

void complete_background(Frame& frame, const FrameContext& context, SamplePosition sample, float far) {
  const antialias::CameraMotion camera(context.camera, context.last_camera, frame.depth.width(), frame.depth.height());
  for (int y = 0; y < frame.depth.height(); ++y)
    for (int x = 0; x < frame.depth.width(); ++x)
      if (float& depth = frame.depth(x, y); !(depth < far)) {
        frame.motion(x, y) = camera.at(x + sample.x / 256.0, y + sample.y / 256.0, double{depth});
        depth = far;
      }
}

LinearImage cropped(LinearImage image, const std::optional<Crop>& crop) {
  if (!crop) return image;
  LinearImage out(crop->width, crop->height);
  for (int y = 0; y < crop->height; ++y)
    std::copy_n(image.row(crop->y + y).begin() + crop->x, crop->width, out.row(y).begin());
  return out;
}

}  // namespace zoneplate::upscale
