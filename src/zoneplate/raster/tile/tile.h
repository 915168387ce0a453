// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/base/clock.h"
#include "zoneplate/raster/tile/alpha_tested.h"
#include "zoneplate/raster/tile/composite.h"
#include "zoneplate/raster/tile/data.h"
#include "zoneplate/raster/tile/job.h"
#include "zoneplate/raster/tile/opaque.h"
#include "zoneplate/raster/tile/output.h"
#include "zoneplate/raster/tile/visibility.h"
#include "zoneplate/raster/types/stage_times.h"

namespace zoneplate {

/// The state of one thread across tiles: the memory of all stages, which stays in its core's cache, and the times.
struct TileBuffers {
  explicit TileBuffers(const TileSetup& setup)
      : job(setup),
        visibility(setup.max_pass_samples()),
        batcher(setup.projected, setup.shader, setup.target),
        alpha_tester(setup) {}

  TileJob job;
  VisibilityBuffer visibility;
  FragmentBatcher batcher;
  AlphaTester alpha_tester;
  OpaqueFragments opaque;
  TileColors colors;
  BlockCompositor blocks;
  SpanCompositor spans;
  PixelCompositor pixels;
  TileData data;
  StageTimes times;
  Stopwatch watch;
};

/// Draws a tile of the bins and writes its pixels to the target.
///
/// The stages are: begin_tile, rasterize_opaque, AlphaTester::rasterize; then, if only colours are stored,
/// shade_opaque, the compositors of composite.h and write_colors. If other planes are stored as well, the passes over
/// the sample pattern add up the samples of each pixel one after the other, and write_data follows. A target without
/// colours is shaded only for data that require it (TileSetup::stores_shaded_data).
void render_tile(std::size_t tile, TileBuffers& buffers);

}  // namespace zoneplate
