// The points of a tile that no row of eight pixels shares: listed, shaded a list at a time, and summed by pixel.
#include <algorithm>
#include <bit>

#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {
namespace {

constexpr int most_known_samples = 8;  ///< of whose sets the weights are found before

}  // namespace

bool TileRenderer::lists_points() const { return !has_layers() && pass_samples_ <= FragmentList::most_samples; }

/// What is said of the rows of a block from column x on; of the first of them so far.
OwnerRow TileRenderer::owner_row_at(int x, int y) const {
  const auto pixel = static_cast<std::uint32_t>(y * tile_size + x);
  const int first = std::clamp(left_ - x, 0, FragmentBatch::group),
            last = std::clamp(right_ - x, first, FragmentBatch::group);
  return {.id = visibility_.id + pixel,
          .sample_count = pass_samples_,
          .first_place = places_.first.data() + first_sample_,
          .more_places = places_.more.data() + first_sample_,
          .pixel = pixel,
          .x = (tile_x_ + x) * 256,
          .y = (tile_y_ + y) * 256,
          .wanted = (1u << last) - (1u << first),
          .is_per_sample = target_.is_per_sample};
}

/// Lists the points of eight neighbouring pixels of a row.
void TileRenderer::list_row(const OwnerRow& row) {
  point_lists_.list(row, list_);
  listed_rows_.push_back(row.pixel);
  if (list_.count >= FragmentList::enough) shade_list();
}

/// Shades what is listed, and gives its rows their colours.
void TileRenderer::shade_list() {
  // Where each pixel is one point, rows follow each other.
  const bool are_whole_rows =
      pass_samples_ == 1 && static_cast<std::size_t>(list_.count) == FragmentBatch::group * listed_rows_.size();
  if (are_whole_rows) {
    shader_.shade(list_, [&](const FragmentOutputs& colors, std::size_t first, std::size_t count) {
      Linear8* row[FragmentBatch::groups];
      for (std::size_t i = 0; i < count; i += FragmentBatch::group)
        row[i / FragmentBatch::group] = &color_[FragmentList::pixel(list_.at[first + i]) / 8];
      resolve_.resolve(colors, 0, static_cast<int>(count) / FragmentBatch::group, weight_sum_, row);
      store_listed(colors, first, count);
    });
  } else {
    sum_list();
  }
  listed_rows_.clear();
  list_.count = 0;
}

void TileRenderer::sum_list() {
  list_sums_.resize(tile_pixels);
  for (const std::uint32_t pixel : listed_rows_)
    std::fill_n(&list_sums_[pixel], FragmentBatch::group, Linear{0, 0, 0, 0});
  shader_.shade(list_, [&](const FragmentOutputs& colors, std::size_t first, std::size_t count) {
    const std::uint32_t* const at = list_.at + first;
    float weight[FragmentBatch::capacity];
    if (const float* const known = samples_weight_.data(); pass_samples_ <= most_known_samples)
      for (std::size_t i = 0; i < count; ++i) weight[i] = known[FragmentList::samples(at[i])];
    else
      for (std::size_t i = 0; i < count; ++i) weight[i] = weight_of(FragmentList::samples(at[i]));
    point_lists_.add(colors, at, weight, static_cast<int>(count), &list_sums_[0].r);
    store_listed(colors, first, count);
  });
  for (const std::uint32_t pixel : listed_rows_)
    point_lists_.divide(&list_sums_[pixel].r, weight_sum_, color_[pixel / 8]);
}

/// The samples of listed points, where they are wanted.
void TileRenderer::store_listed(const FragmentOutputs& colors, std::size_t first, std::size_t count) {
  if (!target_.sample_color) return;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t at = list_.at[first + i];
    store_color(FragmentList::pixel(at), FragmentList::samples(at),
                {colors.r[i], colors.g[i], colors.b[i], colors.a[i]});
  }
}

/// The weight of those samples of the pass, added in their order.
float TileRenderer::weight_of(std::uint32_t samples) const {
  float weight = 0;
  for (; samples; samples &= samples - 1)
    weight += weights_[static_cast<std::size_t>(first_sample_ + std::countr_zero(samples))];
  return weight;
}

/// The weights of all sets of samples that are not too many.
void TileRenderer::find_weights() {
  samples_weight_.resize(std::size_t{1} << std::min<std::size_t>(target_.samples.size(), most_known_samples));
  for (std::uint32_t s = 0; s < samples_weight_.size(); ++s) samples_weight_[s] = weight_of(s);
}

}  // namespace zoneplate
