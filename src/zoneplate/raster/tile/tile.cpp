#include "zoneplate/raster/tile/tile.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

#include "zoneplate/base/deadline.h"

namespace zoneplate {
namespace {

constexpr int samples_per_pass = 16;

/// The storage's first element on a cache line's start; the vector has a line's room to spare.
template <class T>
T* aligned(std::vector<T>& storage) {
  const auto address = reinterpret_cast<std::uintptr_t>(storage.data());
  return storage.data() + ((64 - address % 64) % 64) / sizeof(T);
}

}  // namespace

TileRenderer::TileRenderer(const ProjectedDraws& projected, const Bins& bins, const FragmentShader& shader,
                           const RasterRules& rules, const Target& target)
    : projected_(projected),
      bins_(bins),
      coverage_(CoverageKernels::of(rules.isa)),
      resolve_(ResolveKernels::of(rules.isa)),
      point_lists_(FragmentListKernels::of(rules.isa)),
      target_(target),
      setup_(rules.setup(target.viewport)),
      room_(rules.room),
      least_(least_transmittance(shader.brightest())),
      places_(target.samples, target.is_per_sample ? Centroid::First : target.centroid),
      shader_(projected, shader, rules.isa, target),
      digits_(shader, static_cast<int>(target.samples.size()), target.alpha == AlphaTest::Sharp),
      digit_batcher_(projected, digits_, rules.isa, target),
      weights_(target.weights) {
  if (weights_.empty()) weights_.assign(target.samples.size(), 1.0f);
  assert(weights_.size() == target.samples.size());
  for (const float w : weights_) weight_sum_ += w;
  find_weights();
  const std::size_t pass =
      target.is_per_sample ? std::min<std::size_t>(target.samples.size(), samples_per_pass) : target.samples.size();
  assert(pass <= TileTriangle::max_samples);
  depth_storage_.resize(pass * tile_pixels + 16);
  id_storage_.resize(pass * tile_pixels + 16);
  visibility_ = {.sample_count = 0,
                 .depth = aligned(depth_storage_),
                 .id = aligned(id_storage_),
                 .block_min_depth = block_min_depth_,
                 .block_primitive = block_primitive_};
  color_.resize(tile_pixels / 8);
}

/// The samples as they are now, to test triangles against while others are drawn.
TileVisibility TileRenderer::copy_visibility() {
  const std::size_t values = static_cast<std::size_t>(pass_samples_) * tile_pixels;
  copied_depth_.resize(depth_storage_.size());
  copied_id_.resize(id_storage_.size());
  TileVisibility copy = visibility_;
  copy.depth = aligned(copied_depth_), copy.id = aligned(copied_id_);
  std::copy_n(visibility_.depth, values, copy.depth);
  std::copy_n(visibility_.id, values, copy.id);
  return copy;
}

void TileRenderer::render(std::size_t tile) {
  watch_.lap_ms();
  if (wants_color_alone() && bins_.is_empty(tile)) {
    write_background(tile);
    times_.output += watch_.lap_ms();
    return;
  }
  gather(tile);
  if (target_.stores_visibility_alone()) return render_visibility();
  if (is_plain()) return render_plain();
  sum_.assign(tile_pixels / 8, Linear8{});
  covered_.assign(tile_pixels, 0.0f);
  nearest_.assign(tile_pixels, Nearest{});
  const int total = static_cast<int>(target_.samples.size());
  const int step = target_.is_per_sample ? samples_per_pass : total;
  for (int first = 0; first < total; first += step) render_pass(first, std::min(step, total - first));
  finish();
  times_.output += watch_.lap_ms();
}

void TileRenderer::gather(std::size_t tile) {
  tile_ = tile;
  const int column = bins_.first_column + static_cast<int>(tile) % bins_.columns;
  const int row = bins_.first_row + static_cast<int>(tile) / bins_.columns;
  tile_x_ = column * tile_size;
  tile_y_ = row * tile_size;
  left_ = std::max(target_.x - tile_x_, 0);
  top_ = std::max(target_.y - tile_y_, 0);
  right_ = std::min(target_.x + target_.width - tile_x_, tile_size);
  bottom_ = std::min(target_.y + target_.height - tile_y_, tile_size);

  for (std::size_t surface = 0; surface < 3; ++surface) {
    std::vector<const Triangle*>& list = sources_[surface];
    list.clear();
    for (const Bins::Worker& worker : bins_.workers)
      for (const std::uint32_t t : worker.tiles[tile][surface]) list.push_back(&worker.triangles[t]);
  }
  sort_nearest_first(sources_[static_cast<std::size_t>(AlphaMode::Opaque)]);
}

// So that what is hidden is rejected by whole blocks; any order gives the same picture, and a coarse one will do.
void TileRenderer::sort_nearest_first(std::vector<const Triangle*>& list) {
  constexpr std::size_t buckets = 64;
  if (list.size() < 2) return;
  float low = list[0]->z_high, high = low;
  for (const Triangle* t : list) low = std::min(low, t->z_high), high = std::max(high, t->z_high);
  const float scale = high > low ? static_cast<float>(buckets - 1) / (high - low) : 0;
  const auto bucket = [&](const Triangle* t) { return static_cast<std::size_t>((high - t->z_high) * scale); };
  std::uint32_t first[buckets + 1] = {};
  for (const Triangle* t : list) ++first[std::min(bucket(t), buckets - 1) + 1];
  for (std::size_t i = 0; i < buckets; ++i) first[i + 1] += first[i];
  sorted_.resize(list.size());
  for (const Triangle* t : list) sorted_[first[std::min(bucket(t), buckets - 1)]++] = t;
  list.swap(sorted_);
}

bool TileRenderer::wants_color_alone() const {
  const bool has_passes = target_.is_per_sample && target_.samples.size() > samples_per_pass;
  return !target_.wants_data() && !target_.coverage && !target_.pixel_mask && !target_.sample_triangle && !has_passes;
}

bool TileRenderer::is_plain() const {
  return wants_color_alone() && !((target_.is_per_sample || target_.sample_color) && has_layers());
}

void TileRenderer::begin_pass(int first_sample, int sample_count) {
  first_sample_ = first_sample;
  pass_samples_ = sample_count;
  all_samples_ = sample_count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << sample_count) - 1;
  visibility_.sample_count = sample_count;
}

void TileRenderer::render_plain() {
  begin_pass(0, static_cast<int>(target_.samples.size()));
  // Found when first asked for: most pictures need neither, and new memory costs.
  if (target_.is_per_sample) sum_.resize(tile_pixels / 8);
  if (has_layers()) base_.resize(tile_pixels / 8);
  draw_opaque();
  draw_masked();
  times_.visibility += watch_.lap_ms();
  find_rows();
  shade_rows();
  shade_list();
  shader_.shade(points_, colors_, nullptr);
  times_.shading += watch_.lap_ms();
  resolve_points();
  if (has_layers()) {
    times_.output += watch_.lap_ms();
    layer_tile();
    times_.blending += watch_.lap_ms();
  }
  write_colors();
  times_.output += watch_.lap_ms();
}

/// Eight pixels that one triangle owns go on together, the others one by one; where nothing is seen colours begin as
/// nothing.
void TileRenderer::find_rows() {
  rows_.clear();
  points_.clear();
  coverage_.find_owners(visibility_, row_primitive_);
  for (int block = 0; block < TileVisibility::blocks; ++block) {
    const std::int32_t owner = block_primitive_[block];
    const bool is_one = owner != mixed_primitives && owner != no_primitive;
    if (is_one && is_whole_row(block % 8) && !target_.is_per_sample) {
      add_block_of_rows(block, owner);
    } else {
      find_rows_of(block);
    }
  }
}

FragmentSpan TileRenderer::row_at(std::uint32_t pixel, std::int32_t id) const {
  const auto x = static_cast<std::int32_t>(pixel % tile_size), y = static_cast<std::int32_t>(pixel / tile_size);
  return {(tile_x_ + x) * 256 + 128, (tile_y_ + y) * 256 + 128, id, pixel};
}

/// The rows of a block that one triangle owns: not looked at one by one.
void TileRenderer::add_block_of_rows(int block, std::int32_t id) {
  const int first = std::max(block / 8 * 8, top_), last = std::min(block / 8 * 8 + 8, bottom_);
  FragmentSpan row = row_at(static_cast<std::uint32_t>(first * tile_size + block % 8 * 8), id);
  const std::size_t count = rows_.size();
  rows_.resize(count + static_cast<std::size_t>(last - first));
  for (std::size_t i = count; i < rows_.size(); ++i, row.y += 256, row.pixel += tile_size) rows_[i] = row;
}

void TileRenderer::find_rows_of(int block) {
  static constexpr Linear8 nothing{};
  const int x = block % 8 * 8, first = std::max(block / 8 * 8, top_), last = std::min(block / 8 * 8 + 8, bottom_);
  const bool is_whole = is_whole_row(block % 8), lists = lists_points();
  OwnerRow row = owner_row_at(x, first);
  if (row.wanted == 0) return;
  for (int y = first; y < last; ++y, row.id += tile_size, row.pixel += tile_size, row.y += 256) {
    const std::uint32_t pixel = row.pixel;
    const std::int32_t owner = row_primitive_[pixel / 8];
    const bool is_row = owner != mixed_primitives && is_whole;
    if (owner == no_primitive) {
      color_[pixel / 8] = nothing;
    } else if (is_row && target_.is_per_sample) {
      add_row_of_samples(pixel, owner);
    } else if (is_row) {
      rows_.push_back(row_at(pixel, owner));
    } else if (lists) {
      list_row(row);
    } else {
      color_[pixel / 8] = nothing;
      for (int i = std::max(x, left_); i < std::min(x + 8, right_); ++i)
        add_pixel(static_cast<std::uint32_t>(y * tile_size + i));
    }
  }
}

void TileRenderer::add_row_of_samples(std::uint32_t pixel, std::int32_t id) {
  sum_[pixel / 8] = {};
  for (int s = 0; s < pass_samples_; ++s) {
    const Fragment at = point_at(pixel, id, std::uint64_t{1} << s);
    rows_.push_back({at.x, at.y, id, pixel});
  }
}

void TileRenderer::shade_rows() {
  if (!target_.is_per_sample) {
    shader_.shade(rows_, [&](std::span<const std::uint32_t> numbers, const FragmentOutputs& color) {
      const auto resolve = [&](float weight, std::vector<Linear8>& to) {
        Linear8* out[FragmentBatch::groups];
        for (std::size_t i = 0; i < numbers.size(); ++i) out[i] = &to[rows_[numbers[i]].pixel / 8];
        resolve_.resolve(color, 0, static_cast<int>(numbers.size()), weight, out);
      };
      resolve(weight_sum_, color_);
      if (has_layers()) resolve(1, base_);
      if (!target_.sample_color) return;
      for (std::size_t i = 0; i < numbers.size(); ++i)
        for (int s = 0; s < pass_samples_; ++s)
          store_row(rows_[numbers[i]].pixel, s, color, static_cast<int>(i) * FragmentBatch::group);
    });
    return;
  }
  // A row's samples follow one another, and those of one material keep their order.
  const auto samples = static_cast<std::size_t>(pass_samples_);
  std::size_t s = 0;
  shader_.shade(rows_, [&](std::span<const std::uint32_t> numbers, const FragmentOutputs& color) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::uint32_t pixel = rows_[numbers[i]].pixel;
      const int first = static_cast<int>(i) * FragmentBatch::group;
      resolve_.add(color, first, weights_[s], sum_[pixel / 8]);
      if (target_.sample_color) store_row(pixel, static_cast<int>(s), color, first);
      s = s + 1 == samples ? 0 : s + 1;
      if (s == 0) resolve_.divide(sum_[pixel / 8], weight_sum_, color_[pixel / 8]);
    }
  });
}

/// One point for each triangle that owns samples of the pixel, in the order of their first samples; or one for each
/// sample.
void TileRenderer::add_pixel(std::uint32_t pixel) {
  if (pass_samples_ == 1 || target_.is_per_sample) {
    for (int s = 0; s < pass_samples_; ++s) {
      const std::int32_t id = visibility_.id[static_cast<std::size_t>(s) * tile_pixels + pixel];
      if (id != no_primitive) points_.push_back(point_at(pixel, id, std::uint64_t{1} << s));
    }
    return;
  }
  std::uint64_t left = all_samples_;
  while (left) {
    const std::int32_t id = visibility_.id[static_cast<std::size_t>(std::countr_zero(left)) * tile_pixels + pixel];
    std::uint64_t owned = 0;
    for (std::uint64_t rest = left; rest; rest &= rest - 1) {
      const int s = std::countr_zero(rest);
      if (visibility_.id[static_cast<std::size_t>(s) * tile_pixels + pixel] == id) owned |= std::uint64_t{1} << s;
    }
    left &= ~owned;
    if (id != no_primitive) points_.push_back(point_at(pixel, id, owned));
  }
}

/// first_point_: by pixel; past the last point where a pixel has none.
void TileRenderer::find_first_points() {
  first_point_.assign(tile_pixels + 1, static_cast<std::uint32_t>(points_.size()));
  for (std::size_t p = points_.size(); p-- > 0;) first_point_[points_[p].pixel] = static_cast<std::uint32_t>(p);
}

void TileRenderer::resolve_points() {
  for (std::size_t first = 0; first < points_.size();) {
    const std::uint32_t pixel = points_[first].pixel;
    Linear sum{0, 0, 0, 0};
    for (; first < points_.size() && points_[first].pixel == pixel; ++first) {
      if (target_.sample_color) store_color(pixel, points_[first].samples, colors_[first]);
      float weight = 0;
      for (std::uint64_t left = points_[first].samples; left; left &= left - 1)
        weight += weights_[static_cast<std::size_t>(std::countr_zero(left))];
      sum = sum + colors_[first] * weight;
    }
    color_[pixel / 8].set(pixel % 8, mean_of(sum));
  }
}

void TileRenderer::render_pass(int first_sample, int sample_count) {
  begin_pass(first_sample, sample_count);
  draw_opaque();
  draw_masked();
  times_.visibility += watch_.lap_ms();
  visibility_.materialize_all();
  find_points();
  shader_.shade(points_, colors_, shades_data() ? &data_ : nullptr);
  times_.shading += watch_.lap_ms();
  accumulate();
  times_.blending += watch_.lap_ms();
  note_nearest();
}

void TileRenderer::draw_opaque() {
  visibility_.clear();
  for (int block = 0; block < TileVisibility::blocks; ++block)
    if (!is_drawn(block)) block_min_depth_[block] = std::numeric_limits<float>::infinity();
  float tile_far = 0;  // no sample of the tile is below it
  std::size_t number = 0;
  for (const Triangle* t : sources_[static_cast<std::size_t>(AlphaMode::Opaque)]) {
    if (++number % deadline_stride == 0) check_deadline();
    if (t->z_high < tile_far) continue;
    make_tile_triangle(*t, target_.samples.data() + first_sample_, pass_samples_, tile_x_, tile_y_, tile_triangle_);
    if (greatest_depth(tile_triangle_, pass_samples_) < tile_far) continue;
    const bool has_risen = coverage_.draw(tile_triangle_, visibility_);
    const bool is_large = tile_triangle_.last_x - tile_triangle_.first_x >= tile_size / 2 &&
                          tile_triangle_.last_y - tile_triangle_.first_y >= tile_size / 2;
    if (has_risen && is_large) tile_far = *std::min_element(std::begin(block_min_depth_), std::end(block_min_depth_));
  }
  draw_fragments();
}

Fragment TileRenderer::point_at(std::uint32_t pixel, std::int32_t id, std::uint64_t samples) const {
  const bool is_centre = samples == all_samples_ && !target_.is_per_sample;
  return point_at(pixel, id, samples, is_centre ? SamplePosition{} : places_.of(samples, first_sample_));
}

Fragment TileRenderer::point_at(std::uint32_t pixel, std::int32_t id, std::uint64_t samples,
                                SamplePosition place) const {
  const std::int32_t x = (tile_x_ + static_cast<std::int32_t>(pixel % tile_size)) * 256;
  const std::int32_t y = (tile_y_ + static_cast<std::int32_t>(pixel / tile_size)) * 256;
  return {x + place.x, y + place.y, id, pixel, samples};
}

void TileRenderer::add_points(std::uint32_t pixel, std::int32_t id, std::uint64_t samples, bool is_each_sample,
                              std::vector<Fragment>& points) const {
  if (!is_each_sample) return points.push_back(point_at(pixel, id, samples));
  for (std::uint64_t left = samples; left; left &= left - 1) {
    const auto s = static_cast<std::size_t>(first_sample_ + std::countr_zero(left));
    points.push_back(point_at(pixel, id, left & (~left + 1), target_.samples[s]));
  }
}

void TileRenderer::find_points() {
  points_.clear();
  first_point_.resize(tile_pixels + 1);
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel) {
    first_point_[pixel] = static_cast<std::uint32_t>(points_.size());
    if (!is_wanted(static_cast<int>(pixel % tile_size), static_cast<int>(pixel / tile_size))) continue;
    add_pixel(pixel);
  }
  first_point_[tile_pixels] = static_cast<std::uint32_t>(points_.size());
}

void TileRenderer::accumulate() {
  if (!sources_[static_cast<std::size_t>(AlphaMode::Blend)].empty() || target_.stores_samples()) {
    // In strips, so that the list of layers stays small however deep they lie.
    constexpr int strip = 8;
    for (int y = 0; y < tile_size; y += strip)
      blend({0, std::max(y, top_), tile_size, std::min(y + strip, bottom_)}, nullptr, &TileRenderer::blend_samples);
    return;
  }
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel) add_surfaces(pixel);
}

void TileRenderer::add_surfaces(std::uint32_t pixel) {
  for (std::uint32_t p = first_point_[pixel]; p < first_point_[pixel + 1]; ++p) {
    float weight = 0;
    for (std::uint64_t left = points_[p].samples; left; left &= left - 1)
      weight += weights_[static_cast<std::size_t>(first_sample_ + std::countr_zero(left))];
    add_to_sum(pixel, colors_[p] * weight);
    covered_[pixel] += static_cast<float>(std::popcount(points_[p].samples));
  }
}

}  // namespace zoneplate
