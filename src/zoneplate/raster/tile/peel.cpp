// TransparentStack of one pixel that has more of them than a thread holds at once: found from near to far, so many at a
// time.
//
// Source: depth peeling, Everitt, Interactive Order-Independent Transparency, 2001; several layers a pass: Bavoil and
// Myers, Order Independent Transparency with Dual Depth Peeling, 2008.
#include <algorithm>
#include <limits>

#include "zoneplate/base/deadline.h"
#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

/// Lays the layers of one sample over `behind`; the layers, their order and their colours are those of `add_layers`.
void TileRenderer::peel_layers(std::uint32_t pixel, int sample, Linear& behind) {
  TransparentStack layers;
  Peel last{std::numeric_limits<float>::infinity(), -1, 0};
  bool has_any = false;
  while (layers.transmittance > least_) {
    find_next_layers(pixel, sample, last);
    if (peeled_.empty()) break;
    has_any = true;
    layer_points_.clear();
    for (const Peel& layer : peeled_)
      layer_points_.push_back(target_.is_per_sample ? point_at(pixel, layer.id, std::uint64_t{1} << sample)
                                                    : point_at(pixel, layer.id, layer.samples));
    shader_.shade(layer_points_, layer_colors_, nullptr);
    for (const Linear& color : layer_colors_) layers.composite_under(color, least_);
    last = peeled_.back();
  }
  if (has_any) behind = layers.over(behind);
}

/// peeled_: the nearest layers of a sample behind `last`, at most as many as are held at once, in their order.
void TileRenderer::find_next_layers(std::uint32_t pixel, int sample, const Peel& last) {
  const std::vector<const Triangle*>& triangles = sources_[static_cast<std::size_t>(AlphaMode::Blend)];
  const std::size_t most = std::max<std::size_t>(room_.layer_samples, 1);
  const auto nearest_stay = [&] {
    if (peeled_.size() <= most) return;
    std::nth_element(peeled_.begin(), peeled_.begin() + static_cast<std::ptrdiff_t>(most), peeled_.end());
    peeled_.resize(most);
  };
  peeled_.clear();
  for (std::size_t number = 0, end = 0; number < triangles.size(); number = end) {
    while (end < triangles.size() && triangles[end]->id == triangles[number]->id) ++end;
    if (number % deadline_stride == 0) check_deadline();
    const Peel layer = layer_of(std::span(triangles).subspan(number, end - number), pixel, sample);
    if (!(layer.samples >> sample & 1) || !(last < layer)) continue;
    peeled_.push_back(layer);
    if (peeled_.size() >= 2 * most) nearest_stay();
  }
  nearest_stay();
  std::sort(peeled_.begin(), peeled_.end());
}

/// The pixel's layer of a triangle, which is given by its pieces: all its samples, and its depth at one of them.
TileRenderer::Peel TileRenderer::layer_of(std::span<const Triangle* const> pieces, std::uint32_t pixel, int sample) {
  const int x = static_cast<int>(pixel % tile_size), y = static_cast<int>(pixel / tile_size);
  Peel layer{-std::numeric_limits<float>::infinity(), pieces[0]->id, 0};
  for (const Triangle* piece : pieces) {
    if (!make_triangle_in(*piece, {x, y, x + 1, y + 1})) continue;
    const int count = coverage_.collect(tile_triangle_, visibility_, fragments_.data());
    for (int i = 0; i < count; ++i) {
      const CoveredPixel& f = fragments_[static_cast<std::size_t>(i)];
      if (f.pixel != pixel) continue;
      layer.samples |= f.samples;
      if (f.samples >> sample & 1) layer.depth = std::max(layer.depth, depth_at(tile_triangle_, sample, x, y));
    }
  }
  return layer;
}

}  // namespace zoneplate
