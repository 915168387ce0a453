// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// The unit normal of a triangle, on the side from which a, b, c run counter-clockwise; +Y where it has none or a point
/// is not finite. In double, so that no square of finite floats overflows or vanishes.
float3 flat_normal(float3 a, float3 b, float3 c);

/// That of many triangles.
struct FlatNormalKernels : PerIsa<FlatNormalKernels> {
  /// Shape     a triangle's corners are nine floats, little-endian, at any address, `stride` >= 36 bytes after those of
  ///           the one before; its normal is written three times, once for each corner.
  void (*make)(const std::uint8_t* corners, std::size_t stride, std::size_t triangles, float* normal);
};

/// Replaces the normals by flat ones: every triangle gets its own three vertices.
///
/// Requires  triangles.
void make_flat_normals(Mesh& mesh);

}  // namespace zoneplate
