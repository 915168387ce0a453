// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "zoneplate/raster/geometry/bin.h"
#include "zoneplate/raster/geometry/draw.h"
#include "zoneplate/raster/types/fragment_shader.h"
#include "zoneplate/raster/types/raster_rules.h"
#include "zoneplate/raster/types/stage_times.h"
#include "zoneplate/raster/types/target.h"

namespace zoneplate {

/// Memory that consecutive frames may share.
struct RasterMemory {
  ProjectedDraws projected;
  Bins bins;
  Rgba8Image display8;  ///< an earlier image whose memory is free, if there is one
};

struct RasterCounts {
  double geometry_ms = 0, tiles_ms = 0;
  StageTimes stages;
  std::uint64_t vertices = 0, triangles = 0, set_up = 0, shaded = 0;
  std::uint64_t evaluated = 0;  ///< fragments whose data alone were evaluated, without light
};

/// The first stages: projects, clips, sets up and bins the triangles, in `memory`.
void bin_draws(std::span<const Draw> draws, const RasterRules& rules, const Target& target, RasterMemory& memory,
               RasterCounts& counts);

/// Draws triangles into a target: projects, clips, sets up and bins them; then, tile by tile, finds the visible
/// triangles, shades once per surface and pixel (or per sample), composites blended surfaces in exact order, and
/// resolves the samples.
///
/// Exact     the result does not depend on the number of threads, the instruction set, or the order of the draws where no two
///           triangles have equal depth at a sample.
/// Source    visibility buffer: Burns and Hunt, The Visibility Buffer, JCGT 2(2), 2013; exact order per sample:
///           Carpenter, The A-buffer, SIGGRAPH 1984.
/// A `memory` that was used for an earlier frame avoids page faults.
RasterCounts rasterize(std::span<const Draw> draws, const FragmentShader& shader, const RasterRules& rules,
                       const Target& target, RasterMemory* memory = nullptr);

}  // namespace zoneplate
