// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/data.h"

#include <bit>

#include "zoneplate/raster/geometry/triangle_facing.h"

namespace zoneplate {
namespace {

/// Copies the data of shaded fragment f to a pixel.
void keep_data(const Target& target, std::uint32_t pixel, std::size_t f, TileData& data) {
  const auto keep = [&](auto& by_pixel, const auto& shaded) {
    by_pixel.resize(tile_pixels);
    by_pixel[pixel] = shaded[f];
  };
  if (target.normal) keep(data.pixels.normal, data.shaded.normal);
  if (target.uv) keep(data.pixels.uv, data.shaded.uv);
  if (target.albedo) keep(data.pixels.albedo, data.shaded.albedo);
  if (target.stores_footprint()) keep(data.pixels.footprint, data.shaded.footprint);
}

/// The depth of the triangle's plane at the fragment: that of the nearest sample if the fragment lies there, as it was
/// tested. Painter's depth is the same everywhere. A plane that reaches the far plane at the fragment keeps the
/// sample's depth, so that it stays in front of it.
float depth_of(const TileJob& job, const Fragment& fragment, std::size_t draw, const NearestSurface& nearest) {
  const RasterRules& rules = job.setup.rules;
  if (nearest.position == nearest.sample || rules.visibility == Visibility::Painter) return nearest.depth;
  const float depth =
      depth_at_point(job.setup.projected, draw, fragment.id, fragment.x, fragment.y, job.setup.target.viewport, rules);
  return depth > 0 ? depth : nearest.depth;
}

void write_pixel(const TileJob& job, std::uint32_t pixel, const TileData& data) {
  const Target& target = job.setup.target;
  const ProjectedDraws& projected = job.setup.projected;
  const NearestSurface& nearest = data.nearest[pixel];
  const Fragment fragment = job.fragment_at(pixel, nearest.id, 0, nearest.position);
  const int x = job.target_x(pixel), y = job.target_y(pixel);
  const auto store = [&](auto* plane, const auto& value) {
    if (plane) (*plane)(x, y) = value;
  };
  const std::size_t d = projected.draw_of(fragment.id);
  const Draw& draw = projected.draws[d];
  store(target.instance, draw.instance);
  store(target.material, static_cast<std::uint32_t>(draw.material));
  store(target.primitive, draw.primitive_of(static_cast<std::uint32_t>(fragment.id - projected.first_triangle[d])));
  store(target.data_position, nearest.position);
  if (target.reversed_depth) store(target.reversed_depth, depth_of(job, fragment, d, nearest));
  if (target.normal) store(target.normal, data.pixels.normal[pixel]);
  if (target.uv) store(target.uv, data.pixels.uv[pixel]);
  if (target.albedo) store(target.albedo, data.pixels.albedo[pixel]);
  if (target.mip_level) store(target.mip_level, data.pixels.footprint[pixel].x);
  if (target.anisotropy) store(target.anisotropy, data.pixels.footprint[pixel].y);
}

}  // namespace

void collect_nearest_surfaces(const TileJob& job, const TileVisibility& visibility, const OpaqueFragments& opaque,
                              bool is_shaded, TileData& data) {
  const Target& target = job.setup.target;
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel)
    for (std::uint32_t f = opaque.first_fragment[pixel]; f < opaque.first_fragment[pixel + 1]; ++f) {
      const Fragment& fragment = opaque.fragments[f];
      NearestSurface& nearest = data.nearest[pixel];
      if (nearest.first_id == no_primitive) nearest.first_id = fragment.id;
      if (nearest.first_id == fragment.id) nearest.first_owns += std::popcount(fragment.samples);
      for (std::uint64_t left = fragment.samples; left; left &= left - 1) {
        const int s = std::countr_zero(left);
        const float z = visibility.depth[static_cast<std::size_t>(s) * sample_stride + pixel];
        if (z < nearest.depth || (z == nearest.depth && fragment.id >= nearest.id)) continue;
        nearest.depth = z, nearest.id = fragment.id;
        nearest.sample = target.samples[static_cast<std::size_t>(job.pass.first + s)];
        nearest.position = {static_cast<std::uint8_t>(fragment.x & 255), static_cast<std::uint8_t>(fragment.y & 255)};
        if (is_shaded) keep_data(target, pixel, f, data);
      }
    }
}

void write_data(const TileJob& job, FragmentBatcher& batcher, bool is_shaded, TileData& data) {
  data.fragments.clear();
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel) {
    NearestSurface& nearest = data.nearest[pixel];
    if (nearest.id == no_primitive) continue;
    const bool is_whole = nearest.first_owns == job.setup.samples();
    const SamplePosition place = job.setup.target.has_data_at_samples ? nearest.sample
                                 : is_whole                           ? SamplePosition{}
                                                                      : nearest.position;
    const bool moves = !(nearest.position == place);
    if (moves) nearest.position = place;
    if (moves || !is_shaded) data.fragments.push_back(job.fragment_at(pixel, nearest.id, 0, nearest.position));
  }
  if (job.setup.stores_shaded_data()) {
    batcher.shade_data(data.fragments, data.shaded);
    for (std::size_t f = 0; f < data.fragments.size(); ++f)
      keep_data(job.setup.target, data.fragments[f].pixel, f, data);
  }
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel)
    if (data.nearest[pixel].id != no_primitive) write_pixel(job, pixel, data);
}

}  // namespace zoneplate
