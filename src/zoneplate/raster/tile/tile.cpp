// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/tile.h"

#include <algorithm>
#include <bit>

namespace zoneplate {
namespace {

void rasterize_pass(int first, int count, TileBuffers& b) {
  begin_pass(first, count, b.job);
  rasterize_opaque(b.job, b.visibility);
  b.alpha_tester.rasterize(b.job, b.batcher, b.visibility);
  b.times.visibility += b.watch.lap_ms();
}

/// Whether the stages of render_colors can give all that the target stores.
bool stores_simple_colors(const TileJob& job) {
  const Target& target = job.setup.target;
  return job.setup.stores_color_alone() && !((target.is_per_sample || target.sample_color) && job.has_transparency());
}

void render_visibility(TileBuffers& b) {
  rasterize_pass(0, b.job.setup.samples(), b);
  b.visibility.materialize_all();
  write_visibility(b.job, b.visibility);
  b.times.output += b.watch.lap_ms();
}

void render_colors(TileBuffers& b) {
  rasterize_pass(0, b.job.setup.samples(), b);
  shade_opaque(b.job, b.visibility, b.batcher, b.opaque, b.colors);
  b.times.shading += b.watch.lap_ms();
  resolve_fragments(b.job, b.opaque, b.colors);
  if (b.job.has_transparency()) {
    b.times.output += b.watch.lap_ms();
    const std::uint64_t others = b.blocks.composite(b.job, b.visibility, b.batcher, b.opaque, b.colors);
    b.spans.composite(b.job, b.visibility, b.batcher, others, b.opaque, b.pixels, b.colors);
    b.times.blending += b.watch.lap_ms();
  }
  write_colors(b.job, b.colors);
  b.times.output += b.watch.lap_ms();
}

/// Adds the samples of a pixel, with its transparent layers, to the sums, and stores them where they are stored one by
/// one.
void add_samples(const PixelLayers& layers, TileBuffers& b) {
  const Target& target = b.job.setup.target;
  const std::uint32_t pixel = layers.pixel;
  if (layers.is_empty() && !target.stores_samples()) return add_fragments_to_sum(b.job, b.opaque, pixel, b.colors);
  const int samples = b.job.pass.count;
  Linear behind[TileTriangle::max_samples];
  std::fill_n(behind, samples, Linear{0, 0, 0, 0});
  for (std::uint32_t f = b.opaque.first_fragment[pixel]; f < b.opaque.first_fragment[pixel + 1]; ++f)
    for (std::uint64_t left = b.opaque.fragments[f].samples; left; left &= left - 1) {
      behind[std::countr_zero(left)] = b.opaque.colors[f];
      b.colors.coverage[pixel] += 1;
    }
  b.pixels.composite(b.job, layers, b.visibility, b.batcher, behind);
  Linear8& sum = b.colors.sum[pixel / 8];
  for (int s = 0; s < samples; ++s) {
    const float weight = b.job.setup.weights[static_cast<std::size_t>(b.job.pass.first + s)];
    sum.set(pixel % 8, sum.get(pixel % 8) + behind[s] * weight);
    if (target.stores_samples()) store_sample(b.job, b.visibility, pixel, s, behind[s]);
  }
}

void add_colors(TileBuffers& b) {
  const TileRect& drawn = b.job.drawn;
  if (!b.job.has_transparency() && !b.job.setup.target.stores_samples()) {
    for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel) add_fragments_to_sum(b.job, b.opaque, pixel, b.colors);
    return;
  }
  // In strips, so that the list of layers stays small however deep they are.
  constexpr int strip = 8;
  for (int y = 0; y < tile_size; y += strip)
    b.pixels.for_pixels(b.job, {0, std::max(y, drawn.top), tile_size, std::min(y + strip, drawn.bottom)}, nullptr,
                        b.visibility, b.batcher, [&](const PixelLayers& layers) { add_samples(layers, b); });
}

/// Stores the results of a pass without colour: coverage, and the samples' depths and triangle ids.
void add_visibility(TileBuffers& b) {
  for (const Fragment& fragment : b.opaque.fragments)
    b.colors.coverage[fragment.pixel] += static_cast<float>(std::popcount(fragment.samples));
  if (!b.job.setup.target.stores_samples()) return;
  for (int y = b.job.drawn.top; y < b.job.drawn.bottom; ++y)
    for (int x = b.job.drawn.left; x < b.job.drawn.right; ++x)
      for (int s = 0; b.job.draws(x, y) && s < b.job.pass.count; ++s)
        store_sample(b.job, b.visibility, static_cast<std::uint32_t>(y * tile_size + x), s, {});
}

void render_passes(TileBuffers& b) {
  const TileSetup& setup = b.job.setup;
  const bool is_shaded = setup.stores_color();
  b.colors.sum.assign(tile_pixels / 8, Linear8{});
  b.colors.coverage.assign(tile_pixels, 0.0f);
  b.data.nearest.assign(tile_pixels, NearestSurface{});
  const int total = setup.samples(), step = setup.max_pass_samples();
  for (int first = 0; first < total; first += step) {
    rasterize_pass(first, std::min(step, total - first), b);
    b.visibility.materialize_all();
    list_fragments(b.job, b.visibility, b.opaque);
    if (is_shaded) {
      b.batcher.shade(b.opaque.fragments, b.opaque.colors, setup.stores_shaded_data() ? &b.data.shaded : nullptr);
      b.times.shading += b.watch.lap_ms();
      add_colors(b);
    } else {
      add_visibility(b);
    }
    b.times.blending += b.watch.lap_ms();
    collect_nearest_surfaces(b.job, b.visibility, b.opaque, is_shaded, b.data);
  }
  if (is_shaded) {
    b.colors.color.resize(tile_pixels / 8);
    b.colors.written_spans.fill(0);
    for (std::size_t i = 0; i < b.colors.sum.size(); ++i)
      setup.resolve.divide(b.colors.sum[i], setup.weight_sum, b.colors.color[i]);
    write_colors(b.job, b.colors);
  }
  if (setup.target.stores_data()) write_data(b.job, b.batcher, is_shaded, b.data);
  if (setup.target.coverage) write_coverage(b.job, b.colors.coverage);
  b.times.output += b.watch.lap_ms();
}

}  // namespace

void render_tile(std::size_t tile, TileBuffers& b) {
  const TileSetup& setup = b.job.setup;
  b.watch.lap_ms();
  if (setup.stores_color_alone() && setup.bins.is_empty(tile)) {
    write_background(setup, tile);
    b.times.output += b.watch.lap_ms();
    return;
  }
  if (setup.target.keeps_nearer && setup.bins.is_empty(tile)) return;
  begin_tile(tile, b.job);
  if (setup.target.stores_visibility_alone()) {
    render_visibility(b);
  } else if (stores_simple_colors(b.job)) {
    render_colors(b);
  } else {
    render_passes(b);
  }
}

}  // namespace zoneplate
