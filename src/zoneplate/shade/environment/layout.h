// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/texel_image.h"
#include "zoneplate/shade/environment/cube.h"

namespace zoneplate {

/// How an image holds the directions.
///
/// The six squares of a cube are named as in OpenGL, and seen from inside with x to the left, as three.js does it: the
/// square +z is in the middle of a cross, towards the world's +z, and +x to the right of it, towards the world's -x.
enum class EnvironmentLayout {
  Equirectangular,  ///< see cube_of_equirectangular
  Cross,            ///< 4 × 3 squares, rows (+y), (-x, +z, +x, -z), (-y); or 3 × 4 with -z turned at the bottom
  Strip,            ///< +x, -x, +y, -y, +z, -z beside or below each other
  MirrorBall,       ///< a mirroring ball seen from far away along -z: the middle mirrors +z
  AngularMap,       ///< Debevec's light probes: the middle is -z, the distance from it the angle, the rim +z
};

/// The layout of an image of this size: cubes by their aspect, a mirror ball where it is square, else equirectangular.
EnvironmentLayout layout_of(int width, int height);

/// The image as a cube map of its own resolution.
///
/// Source    the probes: Debevec, Rendering Synthetic Objects into Real Scenes, SIGGRAPH 1998.
/// Edges     as cube_of_equirectangular.
/// Requires  the image is not empty.
CubeImage cube_of(const TexelImage& image, EnvironmentLayout layout);

}  // namespace zoneplate
