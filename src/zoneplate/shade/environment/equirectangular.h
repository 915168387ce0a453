// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/texel_image.h"
#include "zoneplate/shade/environment/cube.h"

namespace zoneplate {

/// The side of the cube map of an equirectangular image of this width, a power of two from 64 to 512: of a large image
/// with its angular resolution, of a small one with twice to four times that, so that lamps of a pixel keep their size.
int cube_side(int equirectangular_width);

/// The radiance of every pixel. Edges: see radiance_of.
Plane<float3> light_of(const TexelImage& image);

/// An equirectangular image as a cube map.
///
/// The column u in [0, 1] and the row v in [0, 1], from the top, have the direction (-cos 2πu sin πv, cos πv,
/// -sin 2πu sin πv): the middle of the image is +x, and v = 0 is +y. The texels have the light of the image, bilinear
/// between its pixels (see cube_of_texels). Codes are decoded from sRGB.
///
/// Edges     radiance that is negative or not a number counts as 0, above 1e9 as 1e9; alpha is ignored.
/// Requires  the image is not empty.
CubeImage cube_of_equirectangular(const TexelImage& image, int side);

}  // namespace zoneplate
