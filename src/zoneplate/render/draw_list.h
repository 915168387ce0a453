// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/raster/geometry/draw.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// The draws of a scene: one for each instance of a mesh, opaque, alpha-tested or blended, in the scene's order.
///
/// Lines and points become quads in clip space (raster/geometry/quads.h) of `line_width` and `point_size` pixels.
struct SceneDraws {
  std::vector<Draw> draws;
  // The data of lines and points to which draws refer, shared by all instances.
  std::vector<QuadMesh> quads;                             ///< by mesh; empty if the scene has no lines or points
  std::vector<std::vector<std::uint32_t>> point_vertices;  ///< by mesh, for points
  std::vector<std::uint32_t> quad_index;
};

SceneDraws make_draws(const Scene& scene, const float4x4& clip_from_world, const RenderOptions& options);

}  // namespace zoneplate
