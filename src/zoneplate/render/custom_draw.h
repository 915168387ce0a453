// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// The arguments of Request::draw, by which a method draws the colour of a frame itself instead of the tiles.
///
/// The method fills `target.color`, and of the other planes only `target.coverage` and `error`, each where it is not
/// null. `target.samples` belong to the data passes and do not apply here.
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
