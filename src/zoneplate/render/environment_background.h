// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/pixel.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// Composites a premultiplied linear image over the environment, which is evaluated at the centres of the pixels. The
/// result is opaque.
///
/// Requires  the image has the size of the crop, or without one of the whole image.
void draw_environment(const Environment& environment, float3 up, const Camera& camera, const RenderOptions& options,
                      LinearImage& image);

}  // namespace zoneplate
