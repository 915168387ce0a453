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

void bin_draws(std::span<const Draw> draws, const RasterRules& rules, const Target& target, RasterMemory& memory,
               RasterCounts& counts) {
  const Stopwatch geometry;
  Stopwatch stage;
  memory.projected = number_draws(draws, target.viewport, rules.capacity.screen_vertices, std::move(memory.projected));
  memory.bins = make_bins(target, std::move(memory.bins));
  project_batches(memory.projected, [&](std::size_t first, std::size_t last) {
    counts.stages.vertices += stage.lap_ms();
    add_to_bins(memory.projected, first, last, target, rules, memory.bins);
    counts.stages.triangles += stage.lap_ms();
  });
  counts.geometry_ms = geometry.ms();
  for (const Draw& draw : draws) counts.vertices += draw.vertices();
  counts.triangles = static_cast<std::uint64_t>(memory.projected.first_triangle.back());
  counts.set_up = memory.bins.set_up;
}

RasterCounts rasterize(std::span<const Draw> draws, const FragmentShader& shader, const RasterRules& rules,
                       const Target& target, RasterMemory* memory) {
  RasterCounts counts;
  RasterMemory own;
  RasterMemory& kept = memory ? *memory : own;
  bin_draws(draws, rules, target, kept, counts);
  const Bins& bins = kept.bins;

  const Stopwatch tiles;
  const TileSetup tile_setup(kept.projected, bins, shader, rules, target);
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
