// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "zoneplate/math/vec.h"
#include "zoneplate/metrics/file/stored.h"
#include "zoneplate/metrics/picture.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate {

/// An image to filter, and the file that it was decoded from.
struct Still {
  metrics::Picture picture;
  metrics::ImageFile file;
};

/// Loads an image to filter within the limits of a confined process, with a warning if it is the first one of an
/// animation. Pixels of scene-linear images that are not finite are filled, with a warning.
///
/// Errors    those of load_picture (metrics/file/picture_file.h), of tell_layer and of fill_not_finite.
Still load_still(const std::string& path, const ExrChoice& exr, Delivery& out);

/// The same for an open file, or a frame of an animation.
metrics::Picture load_still(const metrics::ImageFile& file, Delivery& out);

/// Lays an image with alpha over a background, an sRGB colour with straight alpha, in linear light.
///
/// Requires  light of the picture's space can be encoded (in_space_of, for FilteredValues::Light).
/// Exact     an opaque pixel keeps its values.
void lay_over(metrics::Picture& picture, float4 background);

/// Gives each pixel with a channel that is not finite the mean of those of its eight neighbours that are finite; where
/// all are undefined, from the border of such a region inwards.
///
/// Returns   the number of these pixels.
/// Errors    ErrorKind::Input, with `name` in front, if no pixel is finite.
std::size_t fill_not_finite(LinearImage& image, const std::string& name);

/// Warns of pixels that fill_not_finite filled, if any.
void warn_of_filled(const std::string& name, std::size_t pixels, Delivery& out);

}  // namespace zoneplate
