// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// The unit normal of a triangle, on the side from which a, b, c are counter-clockwise; +Y if the triangle has no area
/// or a point is not finite. In double, so that squares of finite floats neither overflow nor underflow.
float3 flat_normal(float3 a, float3 b, float3 c);

/// Flat normals of many triangles.
struct FlatNormalKernels : PerIsa<FlatNormalKernels> {
  /// Shape     a triangle's corners are nine little-endian floats at any alignment, `stride` >= 36 bytes after those of
  ///           the previous triangle; its normal is written three times, once per corner.
  void (*make)(const std::uint8_t* corners, std::size_t stride, std::size_t triangles, float* normal);
};

/// Replaces the normals by flat ones: every triangle gets its own three vertices.
///
/// Requires  triangles.
void make_flat_normals(Mesh& mesh);

}  // namespace zoneplate
