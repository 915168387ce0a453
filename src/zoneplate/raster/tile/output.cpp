// The last steps of a tile: samples and the resolved colour, written to the target.
#include <algorithm>
#include <bit>
#include <cstring>

#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

void TileRenderer::store_samples(std::uint32_t pixel, int sample, Linear color) {
  const int x = tile_x_ + static_cast<int>(pixel % tile_size) - target_.x;
  const int y = tile_y_ + static_cast<int>(pixel / tile_size) - target_.y;
  const auto s = static_cast<std::size_t>(first_sample_ + sample);
  const std::size_t at = static_cast<std::size_t>(sample) * tile_pixels + pixel;
  if (target_.sample_color) (*target_.sample_color)[s](x, y) = color;
  if (target_.sample_depth) (*target_.sample_depth)[s](x, y) = visibility_.depth[at];
  if (target_.sample_triangle)
    (*target_.sample_triangle)[s](x, y) =
        visibility_.id[at] == no_primitive ? Target::no_id : static_cast<std::uint32_t>(visibility_.id[at]);
}

/// The colour of some samples of a pixel.
void TileRenderer::store_color(std::uint32_t pixel, std::uint64_t samples, Linear color) {
  const int x = tile_x_ + static_cast<int>(pixel % tile_size) - target_.x;
  const int y = tile_y_ + static_cast<int>(pixel / tile_size) - target_.y;
  for (; samples; samples &= samples - 1)
    (*target_.sample_color)[static_cast<std::size_t>(first_sample_ + std::countr_zero(samples))](x, y) = color;
}

/// The colours of one sample of eight pixels of a row.
void TileRenderer::store_row(std::uint32_t pixel, int sample, const FragmentOutputs& color, int first) {
  const int x = tile_x_ + static_cast<int>(pixel % tile_size) - target_.x;
  const int y = tile_y_ + static_cast<int>(pixel / tile_size) - target_.y;
  Linear8 same;
  Linear8* const out = &same;
  resolve_.resolve(color, first, 1, 1, &out);
  resolve_.put(same, &(*target_.sample_color)[static_cast<std::size_t>(first_sample_ + sample)](x, y));
}

void TileRenderer::write_colors() {
  for (int y = top_; y < bottom_; ++y) {
    const Linear8* const row = &color_[static_cast<std::size_t>(y * 8)];
    if (target_.color)
      write_row<Linear>(*target_.color, y, [&](int first, int count, Linear* out) {
        for (int i = 0; i < count; ++i) resolve_.put(row[first + i], out + i * 8);
      });
    if (target_.shown)
      write_row<Rgba8>(*target_.shown, y, [&](int first, int count, Rgba8* out) {
        target_.presenter->present({row + first, static_cast<std::size_t>(count)}, out);
      });
  }
}

/// make(first, count, out) writes whole groups of eight pixels; of those at the edges only a part is wanted.
template <class Pixel, class Make>
void TileRenderer::write_row(Plane<Pixel>& plane, int y, Make make) {
  Pixel* const out = &plane(tile_x_ + left_ - target_.x, tile_y_ + y - target_.y);  // pixel left_
  const int whole = (left_ + 7) / 8, end = right_ / 8;
  if (whole < end) make(whole, end - whole, out + (whole * 8 - left_));
  const auto put_part = [&](int group) {
    Pixel part[8];
    make(group, 1, part);
    const int from = std::max(left_, group * 8), to = std::min(right_, group * 8 + 8);
    std::copy(part + (from - group * 8), part + (to - group * 8), out + (from - left_));
  };
  if (left_ % 8 != 0) put_part(left_ / 8);
  if (right_ % 8 != 0 && (right_ / 8 != left_ / 8 || left_ % 8 == 0)) put_part(right_ / 8);
}

/// Shows an empty tile, and those on its right as far as they are empty: memory likes long rows.
void TileRenderer::write_background(std::size_t tile) {
  if (!target_.shown) return;
  const auto columns = static_cast<std::size_t>(bins_.columns);
  if (tile % columns != 0 && bins_.is_empty(tile - 1)) return;
  std::size_t end = tile + 1;
  while (end % columns != 0 && bins_.is_empty(end)) ++end;

  const auto at = [](int first, std::size_t number) { return (first + static_cast<int>(number)) * tile_size; };
  const int left = std::max(at(bins_.first_column, tile % columns), target_.x);
  const int right = std::min(at(bins_.first_column, tile % columns + (end - tile)), target_.x + target_.width);
  const int y = at(bins_.first_row, tile / columns);
  const int top = std::max(y, target_.y), bottom = std::min(y + tile_size, target_.y + target_.height);
  const auto row = [&](int of) { return &(*target_.shown)(left - target_.x, of - target_.y); };
  const auto count = static_cast<std::size_t>(right - left);
  std::fill_n(row(top), count, target_.presenter->background());
  for (int of = top + 1; of < bottom; ++of) std::memcpy(row(of), row(top), count * sizeof(Rgba8));
}

void TileRenderer::finish() {
  for (std::size_t i = 0; i < sum_.size(); ++i) resolve_.divide(sum_[i], weight_sum_, color_[i]);
  write_colors();
  write_data();
  if (!target_.coverage) return;
  for (int y = top_; y < bottom_; ++y)
    for (int x = left_; x < right_; ++x)
      (*target_.coverage)(tile_x_ + x - target_.x, tile_y_ + y - target_.y) =
          covered_[static_cast<std::size_t>(y * tile_size + x)] / static_cast<float>(target_.samples.size());
}

}  // namespace zoneplate
