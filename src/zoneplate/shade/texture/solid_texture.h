// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/scene/solid_texture.h"

namespace zoneplate {

/// The points of fragments in object space, and their screen-space derivatives per pixel: x, y and z.
struct SolidPoints {
  const float* position[3];
  const float *dx[3], *dy[3];
};

/// Evaluates a solid texture (scene/solid_texture.h) at fragments: red, green and blue, each in [0, 1].
///
/// Requires  a pattern other than None; count is a multiple of 8, and arrays extend to the next multiple of 16.
/// Edges     positions that are not finite give a colour in [0, 1].
struct SolidTextureKernels : PerIsa<SolidTextureKernels> {
  void (*evaluate)(const SolidTexture& texture, const SolidPoints& points, float* const out[3], int count);
};

}  // namespace zoneplate
