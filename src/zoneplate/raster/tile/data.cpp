// The data planes of a tile: of each pixel one point of its nearest surface.
#include <bit>

#include "zoneplate/raster/geometry/triangle_facing.h"
#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

/// pixel_data_: what shading points_[p] gave.
void TileRenderer::keep_data(std::uint32_t pixel, std::size_t p) {
  const auto keep = [&](auto& all, const auto& shaded) {
    all.resize(tile_pixels);
    all[pixel] = shaded[p];
  };
  if (target_.normal) keep(pixel_data_.normal, data_.normal);
  if (target_.uv) keep(pixel_data_.uv, data_.uv);
  if (target_.albedo) keep(pixel_data_.albedo, data_.albedo);
}

/// nearest_: the samples of this pass too, by the order of visibility.
void TileRenderer::note_nearest() {
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel)
    for (std::uint32_t p = first_point_[pixel]; p < first_point_[pixel + 1]; ++p) {
      const Fragment& point = points_[p];
      Nearest& nearest = nearest_[pixel];
      if (nearest.first_id == no_primitive) nearest.first_id = point.id;
      if (nearest.first_id == point.id) nearest.first_owns += std::popcount(point.samples);
      for (std::uint64_t left = point.samples; left; left &= left - 1) {
        const int s = std::countr_zero(left);
        const float z = visibility_.depth[static_cast<std::size_t>(s) * tile_pixels + pixel];
        if (z < nearest.depth || (z == nearest.depth && point.id >= nearest.id)) continue;
        nearest.depth = z, nearest.id = point.id;
        nearest.sample = target_.samples[static_cast<std::size_t>(first_sample_ + s)];
        nearest.place = {static_cast<std::uint8_t>(point.x & 255), static_cast<std::uint8_t>(point.y & 255)};
        keep_data(pixel, p);
      }
    }
}

/// Writes the planes, from nearest_. A triangle that owns all samples of a pixel is taken at the pixel's centre, and
/// shaded there once more if it was not.
void TileRenderer::write_data() {
  if (!target_.wants_data()) return;
  points_.clear();
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel) {
    Nearest& nearest = nearest_[pixel];
    const bool is_whole = nearest.first_owns == static_cast<int>(target_.samples.size());
    if (nearest.id == no_primitive || !is_whole || nearest.place == SamplePosition{}) continue;
    nearest.place = {};
    points_.push_back(point_at(pixel, nearest.id, 0, nearest.place));
  }
  if (shades_data()) shader_.shade(points_, colors_, &data_);
  for (std::size_t p = 0; p < points_.size(); ++p) keep_data(points_[p].pixel, p);
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel)
    if (nearest_[pixel].id != no_primitive) write_data(pixel);
}

void TileRenderer::write_data(std::uint32_t pixel) {
  const Nearest& nearest = nearest_[pixel];
  const Fragment point = point_at(pixel, nearest.id, 0, nearest.place);
  const int x = tile_x_ + static_cast<int>(pixel % tile_size) - target_.x;
  const int y = tile_y_ + static_cast<int>(pixel / tile_size) - target_.y;
  const auto put = [&](auto* plane, const auto& value) {
    if (plane) (*plane)(x, y) = value;
  };
  const std::size_t d = projected_.draw_of(point.id);
  const Draw& draw = projected_.draws[d];
  put(target_.instance, draw.instance);
  put(target_.material, static_cast<std::uint32_t>(draw.material));
  put(target_.primitive, draw.primitive_of(static_cast<std::uint32_t>(point.id - projected_.first_triangle[d])));
  put(target_.place, nearest.place);
  if (target_.reversed_depth) put(target_.reversed_depth, depth_of(point, d, nearest));
  if (target_.normal) put(target_.normal, pixel_data_.normal[pixel]);
  if (target_.uv) put(target_.uv, pixel_data_.uv[pixel]);
  if (target_.albedo) put(target_.albedo, pixel_data_.albedo[pixel]);
}

/// The depth of the triangle's plane at the point: that of the nearest sample if it lies there, as it was tested. A
/// mean depth is the same everywhere, and a plane that ends at the far plane there stays in front of it.
float TileRenderer::depth_of(const Fragment& point, std::size_t draw, const Nearest& nearest) const {
  if (nearest.place == nearest.sample || setup_.is_flat_depth) return nearest.depth;
  const float depth = depth_at_point(projected_, draw, point.id, point.x, point.y, setup_);
  return depth > 0 ? depth : nearest.depth;
}

}  // namespace zoneplate
