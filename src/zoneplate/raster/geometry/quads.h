#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "zoneplate/math/mat.h"

namespace zoneplate {

/// The lines or points of a mesh, each to be drawn as a quad that is made when it is asked for: all instances share
/// this.
///
/// A line is the rectangle about its segment, a point the square about its place. Four vertices a primitive, of which
/// two are about its first end and two about the other; its triangles are (0, 1, 2) and (2, 1, 3). Source rectangular
/// lines: Vulkan specification, Basic Line Segment Rasterization.
struct QuadMesh {
  std::span<const float3> position;
  std::span<const std::uint32_t> ends;  ///< vertices of the mesh, two a primitive; a point's ends are one vertex
  bool has_points = false;              ///< points, not lines
  float2 half_extent;                   ///< half a line's width or a point's side: clip space for one unit of w
  float2 size;                          ///< the picture's, in pixels

  std::size_t vertices() const { return 2 * ends.size(); }
};

/// A primitive's quad in clip space. Attributes at a vertex are those at its `share` of the way between the ends.
struct Quad {
  float4 clip[4];
  float share[4];
};
Quad make_quad(const QuadMesh& mesh, std::size_t primitive, const float4x4& clip_from_object);

}  // namespace zoneplate
