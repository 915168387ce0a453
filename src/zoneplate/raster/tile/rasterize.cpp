// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/rasterize.h"

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/geometry/bin.h"
#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

RasterCounts rasterize(std::span<const Draw> draws, const FragmentShader& shader, const RasterRules& rules,
                       const Target& target, RasterMemory* memory) {
  RasterCounts counts;
  const Stopwatch geometry;
  Stopwatch stage;
  RasterMemory own;
  RasterMemory& kept = memory ? *memory : own;
  kept.projected = number_draws(draws, target.viewport, rules.capacity.screen_vertices, std::move(kept.projected));
  kept.bins = make_bins(target, std::move(kept.bins));
  project_batches(kept.projected, [&](std::size_t first, std::size_t last) {
    counts.stages.vertices += stage.lap_ms();
    add_to_bins(kept.projected, first, last, target, rules, kept.bins);
    counts.stages.triangles += stage.lap_ms();
  });
  const ProjectedDraws& projected = kept.projected;
  const Bins& bins = kept.bins;
  counts.geometry_ms = geometry.ms();
  for (const Draw& draw : draws) counts.vertices += draw.vertices();
  counts.triangles = static_cast<std::uint64_t>(projected.first_triangle.back());
  counts.set_up = bins.set_up;

  const Stopwatch tiles;
  const TileSetup tile_setup(projected, bins, shader, rules, target);
  PerThread<TileBuffers> buffers;
  std::atomic<std::size_t> done = 0;
  parallel_for(bins.tiles(), [&](std::size_t tile) {
    growing("tile buffers", [&] { render_tile(tile, buffers.local(tile_setup)); });
    if (rules.progress) (*rules.progress)(static_cast<double>(++done) / static_cast<double>(bins.tiles()));
  });
  buffers.for_each([&](const TileBuffers& used) {
    counts.shaded += used.batcher.shaded();
    counts.evaluated += used.batcher.evaluated();
    counts.stages += used.times;
  });
  counts.tiles_ms = tiles.ms();
  return counts;
}

}  // namespace zoneplate
