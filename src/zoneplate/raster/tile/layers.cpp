// TransparentStack of a tile: masked surfaces, which are there or not by their alpha, and blended ones, in their exact
// order.
#include <algorithm>
#include <bit>

#include "zoneplate/base/deadline.h"
#include "zoneplate/math/random.h"
#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

/// layers_: of the surface's triangles from number `first` on over the region, as many as fit; gives the number of the
/// first triangle that is left. `rows`, if not null, tells which rows of 8 pixels count.
std::size_t TileRenderer::collect_layers(AlphaMode alpha_mode, std::size_t first, const TileRegion& region,
                                         const std::uint8_t* rows, const TileVisibility& visibility) {
  const std::vector<const Triangle*>& triangles = sources_[static_cast<std::size_t>(alpha_mode)];
  layers_.clear();
  layer_depths_.clear();
  fragments_.resize(tile_pixels);
  std::size_t number = first;
  for (; number < triangles.size(); ++number) {
    const Triangle& t = *triangles[number];
    // The pieces of a clipped triangle follow each other, and are shaded together.
    if (layer_depths_.size() >= room_.layer_samples && number > first && t.id != triangles[number - 1]->id) break;
    if (number % deadline_stride == 0) check_deadline();
    if (!make_triangle_in(t, region)) continue;
    const int count = coverage_.collect(tile_triangle_, visibility, fragments_.data());
    for (int i = 0; i < count; ++i) {
      const CoveredPixel& f = fragments_[static_cast<std::size_t>(i)];
      const int x = static_cast<int>(f.pixel % tile_size), y = static_cast<int>(f.pixel / tile_size);
      if (!region.contains(x, y) || !is_wanted(x, y) || (rows && !rows[f.pixel / 8])) continue;
      layers_.push_back({f.samples, f.pixel, t.id, static_cast<std::uint32_t>(layer_depths_.size())});
      for (std::uint64_t left = f.samples; left; left &= left - 1)
        layer_depths_.push_back(depth_at(tile_triangle_, std::countr_zero(left), x, y));
    }
  }
  // The pieces of a clipped triangle come together, and a pixel's layers too. Depth settles what the pieces share.
  std::sort(layers_.begin(), layers_.end(), [](const Layer& p, const Layer& q) {
    if (p.pixel != q.pixel) return p.pixel < q.pixel;
    return p.id != q.id ? p.id < q.id : p.samples < q.samples;
  });
  return number;
}

/// tile_triangle_: the triangle's part in the region; false if its bounds lie outside.
bool TileRenderer::make_triangle_in(const Triangle& t, const TileRegion& region) {
  if (t.max_y - tile_y_ < region.top || t.min_y - tile_y_ >= region.bottom) return false;
  if (t.max_x - tile_x_ < region.left || t.min_x - tile_x_ >= region.right) return false;
  make_tile_triangle(t, target_.samples.data() + first_sample_, pass_samples_, tile_x_, tile_y_, tile_triangle_);
  tile_triangle_.first_x = std::max(tile_triangle_.first_x, region.left);
  tile_triangle_.last_x = std::min(tile_triangle_.last_x, region.right - 1);
  tile_triangle_.first_y = std::max(tile_triangle_.first_y, region.top);
  tile_triangle_.last_y = std::min(tile_triangle_.last_y, region.bottom - 1);
  return true;
}

/// One point a pixel and triangle, or one a sample and triangle.
void TileRenderer::find_layer_points(bool is_each_sample) {
  layer_points_.clear();
  point_of_layer_.resize(layers_.size());
  for (std::size_t i = 0; i < layers_.size();) {
    std::size_t end = i;
    std::uint64_t samples = 0;
    for (; end < layers_.size() && layers_[end].pixel == layers_[i].pixel && layers_[end].id == layers_[i].id; ++end) {
      samples |= layers_[end].samples;
      point_of_layer_[end] = static_cast<std::uint32_t>(layer_points_.size());
    }
    add_points(layers_[i].pixel, layers_[i].id, samples, is_each_sample, layer_points_);
    i = end;
  }
}

/// The first `count` samples of the pattern, begun at one that is the pixel's own, so that no sample is always first.
std::uint64_t TileRenderer::rotated_samples(std::uint32_t pixel, int count) const {
  const auto x = static_cast<std::uint32_t>(tile_x_) + pixel % tile_size;
  const auto y = static_cast<std::uint32_t>(tile_y_) + pixel / tile_size;
  const int first = static_cast<int>(hash(x, y) % static_cast<std::uint32_t>(pass_samples_));
  std::uint64_t samples = 0;
  for (int i = 0; i < count; ++i) samples |= std::uint64_t{1} << (first + i) % pass_samples_;
  return samples;
}

/// alpha_samples_: of layer_points_.
void TileRenderer::test_alpha() {
  alpha_samples_.assign(layer_points_.size(), 0);
  if (target_.is_per_sample || target_.alpha == AlphaTest::Pixel || target_.alpha == AlphaTest::Samples) {
    shader_.test_alpha(layer_points_, is_there_);
    for (std::size_t i = 0; i < layer_points_.size(); ++i) alpha_samples_[i] = is_there_[i] ? all_samples_ : 0;
    return;
  }
  for (int digit = 0; digit < digits_.digits(); ++digit) {
    digits_.choose(digit);
    digit_batcher_.test_alpha(layer_points_, is_there_);
    for (std::size_t i = 0; i < layer_points_.size(); ++i)
      alpha_samples_[i] += static_cast<std::uint64_t>(is_there_[i]) << digit;
  }
  for (std::size_t i = 0; i < layer_points_.size(); ++i)
    alpha_samples_[i] = rotated_samples(layer_points_[i].pixel, static_cast<int>(alpha_samples_[i]));
}

/// Part by part where there are many; each part's triangles are tested against what was there before the first.
void TileRenderer::draw_masked() {
  const std::size_t triangles = sources_[static_cast<std::size_t>(AlphaMode::Mask)].size();
  if (triangles == 0) return;
  const TileRegion drawn{left_, top_, right_, bottom_};
  visibility_.materialize_all();
  std::size_t next = collect_layers(AlphaMode::Mask, 0, drawn, nullptr, visibility_);
  if (next == triangles) return draw_masked_layers();
  const TileVisibility before = copy_visibility();
  draw_masked_layers();
  while (next < triangles) {
    next = collect_layers(AlphaMode::Mask, next, drawn, nullptr, before);
    draw_masked_layers();
  }
}

/// What passes enters the same minimum over (depth, id) as the opaque triangles did.
void TileRenderer::draw_masked_layers() {
  const bool is_each_sample = target_.is_per_sample || target_.alpha == AlphaTest::Samples;
  find_layer_points(is_each_sample);
  test_alpha();
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    std::uint32_t d = layer.first_depth;
    for (std::uint64_t left = layer.samples; left; left &= left - 1, ++d) {
      const int s = std::countr_zero(left);
      std::size_t point = point_of_layer_[i];
      if (is_each_sample)
        while (!(layer_points_[point].samples >> s & 1)) ++point;
      const std::size_t at = static_cast<std::size_t>(s) * tile_pixels + layer.pixel;
      const float z = layer_depths_[d];
      if (!(alpha_samples_[point] >> s & 1)) continue;
      if (z > visibility_.depth[at] || (z == visibility_.depth[at] && layer.id < visibility_.id[at])) {
        visibility_.materialize_block(
            static_cast<int>(layer.pixel / (8 * tile_size) * 8 + layer.pixel % tile_size / 8));
        visibility_.depth[at] = z;
        visibility_.id[at] = layer.id;
      }
    }
  }
}

/// Blends the pixels of a region, or of those of its rows of 8 that `rows` tells. A region with more layers than are
/// held at once is halved, down to a pixel, whose layers are then found from near to far.
void TileRenderer::blend(const TileRegion& region, const std::uint8_t* rows, BlendPixel blend_pixel) {
  if (region.top >= region.bottom || region.left >= region.right) return;
  const std::size_t triangles = sources_[static_cast<std::size_t>(AlphaMode::Blend)].size();
  const bool is_pixel = region.bottom - region.top == 1 && region.right - region.left == 1;
  if (collect_layers(AlphaMode::Blend, 0, region, rows, visibility_) == triangles) {
    blend_collected(region, blend_pixel);
  } else if (is_pixel) {
    (this->*blend_pixel)({static_cast<std::uint32_t>(region.top * tile_size + region.left), 0, 0, true});
  } else {
    TileRegion first = region, second = region;
    if (region.bottom - region.top > 1) {
      first.bottom = second.top = (region.top + region.bottom) / 2;
    } else {
      first.right = second.left = (region.left + region.right) / 2;
    }
    blend(first, rows, blend_pixel);
    blend(second, rows, blend_pixel);
  }
}

/// The pixels of layers_, and those without layers.
void TileRenderer::blend_collected(const TileRegion& region, BlendPixel blend_pixel) {
  find_layer_points(target_.is_per_sample);
  shader_.shade(layer_points_, layer_colors_, nullptr);
  std::size_t first = 0;
  for (int y = region.top; y < region.bottom; ++y)
    for (int x = region.left; x < region.right; ++x) {
      const auto pixel = static_cast<std::uint32_t>(y * tile_size + x);
      std::size_t last = first;
      while (last < layers_.size() && layers_[last].pixel == pixel) ++last;
      if (is_wanted(x, y)) (this->*blend_pixel)({pixel, first, last, false});
      first = last;
    }
}

/// Every sample shows the layers in front of the surface that it owns, and that through them.
void TileRenderer::blend_samples(const PixelLayers& layers) {
  const std::uint32_t pixel = layers.pixel;
  if (layers.empty() && !target_.stores_samples()) return add_surfaces(pixel);
  Linear behind[TileTriangle::max_samples];
  std::fill_n(behind, pass_samples_, Linear{0, 0, 0, 0});
  for (std::uint32_t p = first_point_[pixel]; p < first_point_[pixel + 1]; ++p)
    for (std::uint64_t left = points_[p].samples; left; left &= left - 1) {
      behind[std::countr_zero(left)] = colors_[p];
      covered_[pixel] += 1;
    }
  lay_over(layers, behind);
  for (int s = 0; s < pass_samples_; ++s) {
    add_to_sum(pixel, behind[s] * weights_[static_cast<std::size_t>(first_sample_ + s)]);
    if (target_.stores_samples()) store_samples(pixel, s, behind[s]);
  }
}

/// behind: by sample, what the layers are laid over, and then the whole.
void TileRenderer::lay_over(const PixelLayers& layers, Linear* behind) {
  if (!layers.is_deep) return add_layers(layers.first, layers.last, behind);
  for (int s = 0; s < pass_samples_; ++s) peel_layers(layers.pixel, s, behind[s]);
}

void TileRenderer::add_layers(std::size_t first, std::size_t last, Linear* behind) {
  // Two pieces of one clipped triangle may share a sample by the snap of their vertices: it must count once.
  bool has_pieces = false;
  for (std::size_t i = first + 1; i < last; ++i) has_pieces = has_pieces || layers_[i].id == layers_[i - 1].id;
  for (int s = 0; s < pass_samples_; ++s) {
    overs_.clear();
    for (std::size_t i = first; i < last; ++i) {
      if (!(layers_[i].samples >> s & 1)) continue;
      const auto rank = static_cast<std::uint32_t>(std::popcount(layers_[i].samples & ((std::uint64_t{1} << s) - 1)));
      std::size_t point = point_of_layer_[i];
      if (target_.is_per_sample)
        while (!(layer_points_[point].samples >> s & 1)) ++point;
      overs_.push_back({layer_depths_[layers_[i].first_depth + rank], layers_[i].id, layer_colors_[point]});
    }
    std::sort(overs_.begin(), overs_.end(),
              [](const Over& p, const Over& q) { return p.depth != q.depth ? p.depth > q.depth : p.id < q.id; });
    TransparentStack layers;
    for (std::size_t i = 0; i < overs_.size() && layers.transmittance > least_; ++i) {
      const bool again = has_pieces && std::any_of(overs_.begin(), overs_.begin() + static_cast<std::ptrdiff_t>(i),
                                                   [&](const Over& o) { return o.id == overs_[i].id; });
      if (!again) layers.composite_under(overs_[i].color, least_);
    }
    if (!overs_.empty()) behind[s] = layers.over(behind[s]);
  }
}

}  // namespace zoneplate
