// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "zoneplate/image/plane.h"

namespace zoneplate::sdf {

/// No pixel of the mask is set.
inline constexpr std::int32_t infinitely_far = std::numeric_limits<std::int32_t>::max();

/// The squared Euclidean distance of each pixel's centre from the nearest centre of a pixel that is not 0.
///
/// Requires  sides of at most 32767 pixels.
/// Exact     integers.
/// Cost      linear in the number of pixels.
/// Source    Felzenszwalb and Huttenlocher, Distance Transforms of Sampled Functions, 2012; with the integer
///           intersections of Meijster, Roerdink and Hesselink, 2000.
Plane<std::int32_t> squared_distances(const Plane<std::uint8_t>& mask);

/// The signed distance of each pixel from the boundary of the mask, which runs half way between a pixel that is set and
/// one that is not: the distance of the nearest centre of the other kind minus ½, negative where the mask is set.
///
/// Requires  the mask has pixels of both kinds.
/// Units     pixels.
Plane<float> signed_distances(const Plane<std::uint8_t>& mask);

/// The coverage of an image of width × height pixels by the region where a field is negative; `scale` output pixels are
/// one of the field's, whose distances are interpolated bilinearly.
///
/// Edges     beyond the centres of the outermost pixels, distances continue as those of the nearest one.
Plane<float> drawn_field(const Plane<float>& distances, int width, int height, double scale);

}  // namespace zoneplate::sdf
