// Blended layers over the resolved surfaces of a tile: by blocks, by rows of eight pixels, or pixel by pixel.
#include <algorithm>
#include <bit>

#include "zoneplate/base/deadline.h"
#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

/// Where triangles cover all of a block and lie in one order there, they are sorted once for the block; the rows of
/// such blocks that lie side by side are shaded layer by layer, as long as anything is seen through them.
void TileRenderer::layer_tile() {
  find_first_points();
  collect_block_layers();
  std::size_t first = 0;
  for (std::uint32_t strip = 0; strip < TileVisibility::blocks; strip += 8) {
    std::span<const BlockLayer> layers[8];
    for (std::uint32_t column = 0; column < 8; ++column) {
      const std::uint32_t block = strip + column;
      std::size_t last = first;
      while (last < block_layers_.size() && block_layers_[last].block == block) ++last;
      const std::span<BlockLayer> all(block_layers_.data() + first, last - first);
      first = last;
      if (all.empty()) continue;
      const bool is_other = other_blocks_ >> block & 1;
      if (!is_other && starts_from_rows(block) && sort_block(all)) {
        layers[column] = all;
      } else {
        other_blocks_ |= std::uint64_t{1} << block;
      }
    }
    blend_blocks(strip, layers);
  }
  if (other_blocks_ == 0) return;
  visibility_.materialize_all();
  for (int y = 0; y < tile_size; y += 8) layer_strip(std::max(y, top_), std::min(y + 8, bottom_));
}

/// block_layers_: block by block; other_blocks_: those where a triangle covers or wins a part, or all where there are
/// more layers than are held at once.
void TileRenderer::collect_block_layers() {
  float nearest[TileVisibility::blocks];
  BlockLayer found[TileVisibility::blocks];
  std::uint32_t begin[TileVisibility::blocks + 1] = {};
  coverage_.find_nearest(visibility_, nearest);
  other_blocks_ = 0;
  unsorted_layers_.clear();
  block_layers_.clear();
  std::size_t number = 0;
  for (const Triangle* t : sources_[static_cast<std::size_t>(AlphaMode::Blend)]) {
    if (++number % deadline_stride == 0) check_deadline();
    make_tile_triangle(*t, target_.samples.data() + first_sample_, pass_samples_, tile_x_, tile_y_, tile_triangle_);
    const int n = coverage_.collect_blocks(tile_triangle_, visibility_, nearest, found, other_blocks_);
    for (int i = 0; i < n; ++i) ++begin[found[i].block + 1];
    unsorted_layers_.insert(unsorted_layers_.end(), found, found + n);
    if (unsorted_layers_.size() > room_.layer_samples) {
      other_blocks_ = ~std::uint64_t{0};
      return;
    }
  }
  for (std::size_t block = 0; block < TileVisibility::blocks; ++block) begin[block + 1] += begin[block];
  block_layers_.resize(unsorted_layers_.size());
  for (const BlockLayer& layer : unsorted_layers_) block_layers_[begin[layer.block]++] = layer;
}

/// True if all of the block is to be drawn, and each of its rows begins with one surface or none.
bool TileRenderer::starts_from_rows(std::uint32_t block) const {
  const int y = static_cast<int>(block / 8 * 8), column = static_cast<int>(block % 8);
  bool is_whole = is_whole_row(column) && y >= top_ && y + 8 <= bottom_;
  for (int i = 0; i < 8; ++i) is_whole = is_whole && row_primitive_[(y + i) * 8 + column] != mixed_primitives;
  return is_whole;
}

/// Nearest first; false if two of the layers may change places within the block, or are pieces of one triangle.
bool TileRenderer::sort_block(std::span<BlockLayer> layers) {
  const auto is_nearer = [](const BlockLayer& p, const BlockLayer& q) { return p.least > q.least; };
  if (!std::is_sorted(layers.begin(), layers.end(), is_nearer)) std::sort(layers.begin(), layers.end(), is_nearer);
  for (std::size_t i = 1; i < layers.size(); ++i)
    if (!(layers[i - 1].least > layers[i].greatest) || layers[i - 1].id == layers[i].id) return false;
  return true;
}

/// `strip`: its first block; `layers`: of its blocks, none where these are not to be drawn here. Nothing is shaded of
/// rows through which nothing more is seen.
void TileRenderer::blend_blocks(std::uint32_t strip, std::span<const BlockLayer> (&layers)[8]) {
  static constexpr Linear8 nothing{};
  const std::uint32_t first_row = strip * 8;
  std::size_t deepest = 0;
  for (std::uint32_t row = 0; row < 64; ++row) strip_layers_[row].clear();
  for (const auto& of_block : layers) deepest = std::max(deepest, of_block.size());
  FragmentSpan rows[64];
  TransparentStack8* under[64];
  for (std::size_t layer = 0; layer < deepest; ++layer) {
    std::size_t count = 0;
    for (std::uint32_t column = 0; column < 8; ++column) {
      if (layer >= layers[column].size()) continue;
      const Fragment centre = point_at((first_row + column) * 8, layers[column][layer].id, all_samples_);
      for (std::uint32_t i = 0; i < 8; ++i) {
        if (!strip_layers_[i * 8 + column].is_open) continue;
        rows[count] = {centre.x, centre.y + 256 * static_cast<std::int32_t>(i), centre.id,
                       centre.pixel + i * tile_size};
        under[count++] = &strip_layers_[i * 8 + column];
      }
    }
    if (count == 0) break;
    shader_.shade_in_order(std::span(rows).first(count),
                           [&](const FragmentOutputs& color, std::size_t first, std::size_t shaded) {
                             resolve_.composite_spans_under(color, static_cast<int>(shaded), least_, under + first);
                           });
  }
  for (std::uint32_t row = 0; row < 64; ++row) {
    if (layers[row % 8].empty()) continue;
    Linear8 color = row_primitive_[first_row + row] == no_primitive ? nothing : base_[first_row + row];
    resolve_.over(strip_layers_[row], color);
    resolve_.resolve_samples(color, weights_.data(), pass_samples_, weight_sum_, color_[first_row + row]);
  }
}

/// The other blocks' layers of a strip of eight lines at most. Where triangles cover eight pixels of a row wholly and
/// lie in one order there, they are sorted, shaded and laid over one another as rows; the other pixels are done one by
/// one. A strip with more layers than are held at once is halved, and of a single line all pixels are done one by one.
void TileRenderer::layer_strip(int top, int bottom) {
  if (top >= bottom || (other_blocks_ >> (top & ~7) & 0xff) == 0) return;
  constexpr std::size_t enough = 256;  // rows of points that are shaded together
  if (!collect_row_layers(top, bottom)) {
    if (bottom - top > 1) {
      layer_strip(top, (top + bottom) / 2);
      return layer_strip((top + bottom) / 2, bottom);
    }
    row_layers_.clear();
    for (int i = 0; i < 8; ++i) is_slow_row_[top * 8 + i] = other_blocks_ >> ((top & ~7) + i) & 1;
  }
  rows_.clear();
  blended_rows_.clear();
  bool has_slow = false;
  std::size_t first = 0;
  for (auto row = static_cast<std::uint32_t>(top * 8); row < static_cast<std::uint32_t>(bottom * 8); ++row) {
    std::size_t last = first;
    while (last < row_layers_.size() && row_layers_[last].row == row) ++last;
    if (!is_slow_row_[row] && !sort_row(first, last)) is_slow_row_[row] = 1;
    has_slow = has_slow || is_slow_row_[row];
    if (!is_slow_row_[row] && last > first) {
      for (; first < last; ++first) {
        const Fragment centre = point_at(row * 8, row_layers_[first].id, all_samples_);
        rows_.push_back({centre.x, centre.y, row_layers_[first].id, row * 8});
      }
      blended_rows_.push_back({row, static_cast<std::uint32_t>(rows_.size())});
      if (rows_.size() >= enough) blend_rows();
    }
    first = last;
  }
  blend_rows();
  if (has_slow) blend({0, top, tile_size, bottom}, is_slow_row_, &TileRenderer::blend_slow_pixel);
}

/// row_layers_: those of triangles that cover rows of the strip wholly, row by row; is_slow_row_: whether a row has
/// others too, or pixels that do not count or start from different surfaces. False if there are more than are held at
/// once.
bool TileRenderer::collect_row_layers(int top, int bottom) {
  SpanLayer found[64];
  std::uint32_t begin[tile_pixels / 8 + 1] = {};
  row_layers_.clear();
  std::fill_n(is_slow_row_ + top * 8, (bottom - top) * 8, std::uint8_t{0});
  std::size_t number = 0;
  for (const Triangle* t : sources_[static_cast<std::size_t>(AlphaMode::Blend)]) {
    if (++number % deadline_stride == 0) check_deadline();
    if (t->max_y - tile_y_ < top || t->min_y - tile_y_ >= bottom) continue;
    make_tile_triangle(*t, target_.samples.data() + first_sample_, pass_samples_, tile_x_, tile_y_, tile_triangle_);
    tile_triangle_.first_y = std::max(tile_triangle_.first_y, top);
    tile_triangle_.last_y = std::min(tile_triangle_.last_y, bottom - 1);
    const int n = coverage_.collect_rows(tile_triangle_, visibility_, other_blocks_, found, is_slow_row_);
    for (int i = 0; i < n; ++i) ++begin[found[i].row + 1];
    row_layers_.insert(row_layers_.end(), found, found + n);
    if (row_layers_.size() > room_.layer_samples) return false;
  }
  for (int row = top * 8; row < bottom * 8; ++row)
    if (begin[row + 1] > 0 && (row_primitive_[row] == mixed_primitives || !is_whole_row(row))) is_slow_row_[row] = 1;

  for (std::size_t row = 0; row < tile_pixels / 8; ++row) begin[row + 1] += begin[row];
  sorted_row_layers_.resize(row_layers_.size());
  for (const SpanLayer& layer : row_layers_) sorted_row_layers_[begin[layer.row]++] = layer;
  row_layers_.swap(sorted_row_layers_);
  return true;
}

/// Nearest first; false if two of the layers may change places within the row, or are pieces of one triangle.
bool TileRenderer::sort_row(std::size_t first, std::size_t last) {
  const auto at = [&](std::size_t i) { return row_layers_.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto is_nearer = [](const SpanLayer& p, const SpanLayer& q) { return p.least > q.least; };
  if (!std::is_sorted(at(first), at(last), is_nearer)) std::sort(at(first), at(last), is_nearer);
  for (std::size_t i = first + 1; i < last; ++i)
    if (!(row_layers_[i - 1].least > row_layers_[i].greatest) || row_layers_[i - 1].id == row_layers_[i].id)
      return false;
  return true;
}

/// Shades rows_ and puts each row's layers under one another.
void TileRenderer::blend_rows() {
  static constexpr Linear8 nothing{};
  TransparentStack8 layers;
  std::size_t layer = 0, first_layer = 0, row = 0;
  shader_.shade_in_order(rows_, [&](const FragmentOutputs& color, std::size_t, std::size_t shaded) {
    for (int i = 0; i < static_cast<int>(shaded); ++i) {
      const BlendedRow& blended = blended_rows_[row];
      if (layer == first_layer) layers.clear();
      resolve_.composite_under(color, i * FragmentBatch::group, least_, layers);
      if (++layer < blended.end) continue;
      Linear8 all = row_primitive_[blended.row] == no_primitive ? nothing : base_[blended.row];
      resolve_.over(layers, all);
      resolve_.resolve_samples(all, weights_.data(), pass_samples_, weight_sum_, color_[blended.row]);
      first_layer = layer;
      ++row;
    }
  });
  rows_.clear();
  blended_rows_.clear();
}

/// A pixel of a slow row: its layers over the surfaces that own its samples, and the mean of these.
void TileRenderer::blend_slow_pixel(const PixelLayers& layers) {
  if (layers.empty()) return;
  const std::uint32_t pixel = layers.pixel;
  Linear behind[TileTriangle::max_samples];
  const std::int32_t owner = row_primitive_[pixel / 8];
  const bool has_points = owner == mixed_primitives || !is_whole_row(static_cast<int>(pixel / 8));
  std::fill_n(behind, pass_samples_,
              has_points || owner == no_primitive ? Linear{0, 0, 0, 0} : base_[pixel / 8].get(pixel % 8));
  for (std::size_t p = first_point_[pixel]; p < points_.size() && points_[p].pixel == pixel; ++p)
    for (std::uint64_t left = points_[p].samples; left; left &= left - 1) behind[std::countr_zero(left)] = colors_[p];
  lay_over(layers, behind);
  Linear sum{0, 0, 0, 0};
  for (int s = 0; s < pass_samples_; ++s) sum = sum + behind[s] * weights_[static_cast<std::size_t>(s)];
  color_[pixel / 8].set(pixel % 8, mean_of(sum));
}

}  // namespace zoneplate
