// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/raster/geometry/clip.h"
#include "zoneplate/raster/geometry/triangle_facing.h"

namespace zoneplate {

/// True if a draw leaves out triangles that are seen clockwise, or counter-clockwise, on the screen.
inline bool is_culled(const Draw& draw, bool is_clockwise) {
  return draw.culls_back_faces && is_clockwise != draw.is_mirrored;
}

/// Calls `use(p, q, r)` for the pieces of a triangle that needs clipping: the fan of what is left of it, if its facing
/// is not culled. A piece that snapping turned over or left without an area is not among them; the others cover its
/// place.
///
/// Requires  `vertices` are the three indices of triangle `id` in draw number `draw`.
template <class Use>
void for_clipped_triangles(const ProjectedDraws& projected, std::size_t draw, std::int32_t id,
                           const std::uint32_t* vertices, Viewport viewport, const Use& use) {
  const Draw& d = projected.draws[draw];
  const ClippedPolygon polygon =
      clip_triangle(d.clip_position(vertices[0]), d.clip_position(vertices[1]), d.clip_position(vertices[2]), viewport);
  if (polygon.count < 3) return;
  const TriangleFacing facing = face_of(projected, draw, id, viewport);
  if (facing.is_degenerate || is_culled(d, facing.is_clockwise)) return;
  for (std::size_t i = 2; i < static_cast<std::size_t>(polygon.count); ++i) {
    const ScreenVertex &p = polygon.vertex[0], &q = polygon.vertex[i - 1], &r = polygon.vertex[i];
    const std::int64_t area = doubled_area(p, q, r);
    if (area != 0 && (area > 0) == facing.is_clockwise) use(p, q, r);
  }
}

}  // namespace zoneplate
