// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "zoneplate/image/rgb.h"

namespace zoneplate::upscale {

/// Applies a filter of opaque images to a display-referred image with alpha: to its colours, continued into the
/// transparent part, and to alpha as an image of equal channels, whose channel `alpha` of the result is taken.
///
/// A filter that sharpens, clamps or adds to luma would change premultiplied colours and alpha unlike each other, which
/// leaves a coloured rim.
///
/// Exact     an opaque image is filtered as it is; one colour of any alpha stays that colour as in an opaque image;
///           the colour of a transparent pixel does not matter.
DisplayImage filter_with_alpha(const DisplayImage& image,
                               const std::function<DisplayImage(const DisplayImage&)>& filter, float Display::*alpha);

/// The pixels around a pixel of which its continued colour is made: a filter of images with alpha reaches so much
/// farther.
constexpr int continued_reach = 4;

}  // namespace zoneplate::upscale
