// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/quads.h"

#include <cmath>

namespace zoneplate {
namespace {

/// The part of a segment in front of the near plane, as parameters from a (0) to b (1); empty if first > last.
struct Part {
  float first = 0, last = 1;
};

Part part_in_front(float4 a, float4 b) {
  const float da = a.w - a.z, db = b.w - b.z;
  if (da < 0 && db < 0) return {1, 0};
  return {da < 0 ? da / (da - db) : 0, db < 0 ? da / (da - db) : 1};
}

/// The unit direction of a segment on the screen, in pixels, y up.
float2 screen_direction(float4 a, float4 b, float2 size) {
  const float2 d{(b.x / b.w - a.x / a.w) * size.x, (b.y / b.w - a.y / a.w) * size.y};
  const float n = length(d);
  return n > 0 && std::isfinite(n) ? float2{d.x / n, d.y / n} : float2{1, 0};
}

/// Two vertices about a and two about b, offset in clip space by offset × w: by the same distance on the screen at
/// every depth.
Quad quad_about(float4 a, float4 b, Part part, const float2 (&offset)[4]) {
  Quad quad;
  for (int k = 0; k < 4; ++k) {
    const float4 p = k < 2 ? a : b;
    quad.clip[k] = {p.x + offset[k].x * p.w, p.y + offset[k].y * p.w, p.z, p.w};
    quad.segment_t[k] = k < 2 ? part.first : part.last;
  }
  return quad;
}

}  // namespace

Quad make_quad(const QuadMesh& mesh, std::size_t primitive, const float4x4& clip_from_object) {
  const auto at = [&](std::size_t end) {
    const float3 p = mesh.position[mesh.segment_vertices[2 * primitive + end]];
    return clip_from_object * float4{p.x, p.y, p.z, 1};
  };
  const float2 e = mesh.half_extent;
  const float4 a = at(0), b = at(1);
  if (mesh.has_points) return quad_about(a, b, {}, {{-e.x, e.y}, {-e.x, -e.y}, {e.x, e.y}, {e.x, -e.y}});
  // The segment is clipped at the near plane before it gets its width, which is undefined behind the plane.
  const Part part = part_in_front(a, b);
  const float4 from = a + (b - a) * part.first, to = a + (b - a) * part.last;
  const float2 d = screen_direction(from, to, mesh.size);
  const float2 side = part.first > part.last ? float2{} : float2{-d.y * e.x, d.x * e.y};
  return quad_about(from, to, part, {side, side * -1, side, side * -1});
}

}  // namespace zoneplate
