#pragma once

#include <vector>

#include "zoneplate/raster/geometry/draw.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// A scene as draws: an instance of a mesh each, opaque, masked and blended alike, in the scene's order.
///
/// Lines and points become quads in clip space (raster/geometry/quads.h) of `line_width` and `point_size` pixels.
struct SceneDraws {
  std::vector<Draw> draws;
  // What the draws of lines and points look at, shared by all instances; kept here because a draw only views it.
  std::vector<QuadMesh> quads;                         ///< by mesh; empty if there are none
  std::vector<std::vector<std::uint32_t>> point_ends;  ///< likewise, of points
  std::vector<std::uint32_t> quad_index;
};

SceneDraws make_draws(const Scene& scene, const float4x4& clip_from_world, const RenderOptions& options);

}  // namespace zoneplate
