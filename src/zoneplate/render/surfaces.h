#pragma once

#include <vector>

#include "zoneplate/raster/draw.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// A scene as draws: an instance of a mesh each, opaque, masked and blended alike, in the scene's order.
///
/// Lines and points become quads in clip space: a line of `line_width` pixels is the rectangle about its segment, a
/// point the square of `point_size` pixels about its place. Source    rectangular lines: Vulkan specification, Basic
/// Line Segment Rasterization.
struct SceneDraws {
  std::vector<Draw> draws;
  /// What the draws of lines and points look at; kept here because a draw only views its arrays.
  struct Quads {
    std::vector<float4> clip;
    std::vector<std::uint32_t> index, source;
  };
  std::vector<Quads> quads;
};

SceneDraws make_draws(const Scene& scene, const float4x4& clip_from_world, const RenderOptions& options);

}  // namespace zoneplate
