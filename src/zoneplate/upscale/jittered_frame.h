// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "zoneplate/base/spec.h"
#include "zoneplate/render/method.h"

namespace zoneplate::upscale {

/// What upscalers of sequences do with the frames that they get and with the images that they make.

/// The size of the frame from which the image is made: that of the context's own frame, or the image's over `scale`.
ImageExtent frame_size(const FrameContext& context, double scale);

/// The parameter `bias`, with its default.
constexpr Param bias_param(double value) {
  return {.name = "bias",
          .meaning = "mip levels by which textures are blurrier (negative: sharper) than the image's pixels require",
          .value = value,
          .low = -4,
          .high = 2,
          .decimals = 2};
}

/// The texture footprint that a scale and the parameter `bias` ask for: Request::footprint.
float footprint_of(double scale, double bias);

/// Where the frame is sampled in its pixels: as the context's own frame is, or at `planned`.
SamplePosition sample_of(const FrameContext& context, SamplePosition planned);

/// The colours over the background, which the display transform would composite after tone mapping: over the colour
/// that tone mapping turns into the background.
///
/// Errors    ErrorKind::Usage if the display options request a transparent background; `name` is the upscaler's.
LinearImage over_background(LinearImage image, const DisplayOptions& display, std::string_view name);

/// Gives pixels without a surface, or with one at `far` or beyond, the depth `far`, and the motion that the camera's
/// causes. `sample` is the position of the frame's samples.
void complete_background(Frame& frame, const FrameContext& context, SamplePosition sample, float far);

/// A copy of the part of an image that a crop names, or of all of it, in `memory` if that has its size.
LinearImage cropped(const LinearImage& image, const std::optional<Crop>& crop, LinearImage memory = {});
LinearImage cropped(LinearImage&& image, const std::optional<Crop>& crop);  // all of it is the image itself

}  // namespace zoneplate::upscale
