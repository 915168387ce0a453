// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "zoneplate/math/mat.h"

namespace zoneplate {

/// The lines or points of a mesh. Each is drawn as a quad, which make_quad computes on demand; all instances share one
/// QuadMesh.
///
/// A line becomes the rectangle around its segment, a point the square around its position. A primitive has four
/// vertices, two at its first end and two at the other; its triangles are (0, 1, 2) and (2, 1, 3).
///
/// Source    rectangular lines: Vulkan specification, Basic Line Segment Rasterization.
struct QuadMesh {
  std::span<const float3> position;
  std::span<const std::uint32_t>
      segment_vertices;     ///< vertices of the mesh, two a primitive; a point's ends are one vertex
  bool has_points = false;  ///< points, not lines
  float2 half_extent;       ///< half a line's width or a point's side: clip space for one unit of w
  float2 size;              ///< of the image, in pixels

  std::size_t vertices() const { return 2 * segment_vertices.size(); }
};

/// The quad of a primitive in clip space. A vertex has the attributes at parameter `segment_t` of the segment, in [0,
/// 1].
struct Quad {
  float4 clip[4];
  float segment_t[4];
};
Quad make_quad(const QuadMesh& mesh, std::size_t primitive, const float4x4& clip_from_object);

}  // namespace zoneplate
