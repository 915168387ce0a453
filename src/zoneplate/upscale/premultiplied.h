// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "zoneplate/image/rgb.h"

namespace zoneplate::upscale {

/// Applies a filter of images with premultiplied alpha, which is a fourth channel like the others, to a
/// display-referred image.
///
/// Requires  the filter's values are in [0, 1], and alpha of an opaque image stays 1.
/// Exact     an opaque image is filtered as it is; the colours of a transparent image are clamped to their alpha.
DisplayImage filter_premultiplied(const DisplayImage& image,
                                  const std::function<DisplayImage(const DisplayImage&)>& filter);

}  // namespace zoneplate::upscale
