// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/plane.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/scene/material.h"

namespace zoneplate {

/// The stencil of a gradient.
enum class GradientStencil {
  Central,  ///< (h(x + 1) - h(x - 1)) / 2
  Sobel,    ///< the mean of the central differences of three rows, by weights 1 2 1: less noise, some blur
};

/// A normal map of a height map: unit normals in tangent space, x to the right, y up the image, z out of it.
struct HeightNormals {
  GradientStencil stencil = GradientStencil::Sobel;
  float strength = 1;                                 ///< height of the value 1 above the value 0, in texels
  Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;  ///< the heights beyond the border
};
/// Exact     a plane of any slope gives its normal to rounding, by both stencils; the same bits on every machine.
Plane<float3> normals_of(const Plane<float>& heights, const HeightNormals& options);

}  // namespace zoneplate
