#pragma once

#include <span>

#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// What a method gets that draws the colour of a frame itself: all that the tiles would get (Request::draw).
///
/// It fills `target.color`, and of the other planes only `target.coverage` and `error`, each where it is not null. The
/// target's samples are those of the data passes and say nothing here.
struct CustomDraw {
  std::span<const Draw> draws;
  const FragmentShader& shader;
  const RasterRules& rules;
  const Target& target;
  const RenderOptions& options;
  Plane<float>* error = nullptr;
  RasterCounts& counts;
  RasterMemory& memory;
};

}  // namespace zoneplate
