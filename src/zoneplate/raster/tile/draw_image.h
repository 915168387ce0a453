// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/image/rgb.h"
#include "zoneplate/raster/geometry/draw.h"
#include "zoneplate/raster/types/fragment_shader.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {

/// Rasterizes draws into an image of their own, linear and premultiplied, without a background.
LinearImage draw_image(std::span<const Draw> draws, const FragmentShader& shader, int width, int height,
                       const SamplePattern& samples, bool is_per_sample);

}  // namespace zoneplate
