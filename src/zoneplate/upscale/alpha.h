// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "zoneplate/image/rgb.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {

/// Applies a filter of opaque images to a display-referred image with alpha: to its colours, continued into the
/// transparent part, and to alpha as an image of equal channels, whose channel `alpha` of the result is taken.
///
/// A filter that sharpens, clamps or adds to luma would change premultiplied colours and alpha unlike each other, which
/// leaves a coloured rim.
///
/// Edges     colours of partial alpha are kept as keep_visible_colors does.
/// Exact     an opaque image is filtered as it is; one colour of any alpha stays that colour as in an opaque image;
///           the colour of a transparent pixel does not matter.
DisplayImage filter_with_alpha(const DisplayImage& image, const UpscaleGrid& grid,
                               const std::function<DisplayImage(const DisplayImage&)>& filter, float Display::*alpha);

/// Clamps the straight colours of upscaled pixels that are neither opaque nor entirely transparent to the range of the
/// visible pixels in the smallest square of the input around them, of up to 2 radius × 2 radius pixels, that has any.
///
/// Where alpha is small, kernels with negative lobes divide by what is left of terms that cancel each other, and
/// sharpening exceeds the colours beside an outline: both would be a coloured rim.
void keep_visible_colors(DisplayImage& upscaled, const DisplayImage& image, const UpscaleGrid& grid, int radius);

/// The pixels around a pixel of which its continued colour is made: a filter of images with alpha reaches so much
/// farther.
constexpr int continued_radius = 4;

}  // namespace zoneplate::upscale
