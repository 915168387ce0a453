// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {

/// Upscales a display-referred image by NVIDIA Image Scaling; of the same size, the image is only sharpened.
///
/// Requires  `sharpness` in [0, 1]; the output is at most twice as wide and as high as the input.
DisplayImage upscale_nis(const DisplayImage& image, const UpscaleGrid& grid, float sharpness);

}  // namespace zoneplate::upscale
