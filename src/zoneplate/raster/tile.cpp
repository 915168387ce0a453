#include "zoneplate/raster/tile.h"

#include <algorithm>
#include <bit>
#include <cassert>

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

TileRenderer::TileRenderer(const ProjectedDraws& projected, const Bins& bins, const PointShader& shader, Isa isa,
                           const Target& target)
    : projected_(projected),
      bins_(bins),
      coverage_(coverage_kernels(isa)),
      target_(target),
      shader_(projected, shader, isa, target),
      weights_(target.weights) {
  if (weights_.empty()) weights_.assign(target.samples.size(), 1.0f);
  assert(weights_.size() == target.samples.size());
  for (const float w : weights_) weight_sum_ += w;
  const std::size_t pass =
      target.is_per_sample ? std::min<std::size_t>(target.samples.size(), samples_per_pass) : target.samples.size();
  assert(pass <= TileTriangle::max_samples);
  depth_storage_.resize(pass * tile_pixels + 16);
  id_storage_.resize(pass * tile_pixels + 16);
  visibility_ = {
      .sample_count = 0, .depth = aligned(depth_storage_), .id = aligned(id_storage_), .block_far = block_far_};
  first_point_.resize(tile_pixels + 1);
  fragments_.resize(tile_pixels);
  sum_.resize(tile_pixels);
  covered_.resize(tile_pixels);
  nearest_.resize(tile_pixels);
}

void TileRenderer::render(std::size_t tile) {
  gather(tile);
  std::fill(sum_.begin(), sum_.end(), Linear{0, 0, 0, 0});
  std::fill(covered_.begin(), covered_.end(), 0.0f);
  std::fill(nearest_.begin(), nearest_.end(), Nearest{0, no_triangle});
  const int total = static_cast<int>(target_.samples.size());
  const int step = target_.is_per_sample ? samples_per_pass : total;
  for (int first = 0; first < total; first += step) render_pass(first, std::min(step, total - first));
  finish();
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

  // Nearest first, so that what is hidden is rejected by whole blocks; any order gives the same picture.
  for (std::size_t surface = 0; surface < 3; ++surface) {
    std::vector<const Triangle*>& list = sources_[surface];
    list.clear();
    for (const Bins::Worker& worker : bins_.workers)
      for (const std::uint32_t t : worker.tiles[tile][surface]) list.push_back(&worker.triangles[t]);
    std::sort(list.begin(), list.end(), [](const Triangle* p, const Triangle* q) {
      return p->z_high != q->z_high ? p->z_high > q->z_high : p->id < q->id;
    });
  }
}

void TileRenderer::render_pass(int first_sample, int sample_count) {
  first_sample_ = first_sample;
  pass_samples_ = sample_count;
  all_samples_ = sample_count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << sample_count) - 1;
  visibility_.sample_count = sample_count;
  draw_opaque();
  draw_masked();
  find_points();
  shader_.shade(points_, colors_, &data_);
  accumulate();
  note_nearest();
}

void TileRenderer::draw_opaque() {
  const std::size_t values = static_cast<std::size_t>(pass_samples_) * tile_pixels;
  std::fill_n(visibility_.depth, values, 0.0f);
  std::fill_n(visibility_.id, values, no_triangle);
  std::fill_n(block_far_, 64, 0.0f);
  for (const Triangle* t : sources_[static_cast<std::size_t>(Surface::Opaque)]) {
    make_tile_triangle(*t, target_.samples.data() + first_sample_, pass_samples_, tile_x_, tile_y_, tile_triangle_);
    coverage_.draw(tile_triangle_, visibility_);
  }
  draw_fragments();
}

void TileRenderer::collect_layers(Surface surface, int top, int bottom) {
  layers_.clear();
  layer_depths_.clear();
  for (const Triangle* t : sources_[static_cast<std::size_t>(surface)]) {
    if (t->max_y - tile_y_ < top || t->min_y - tile_y_ >= bottom) continue;
    make_tile_triangle(*t, target_.samples.data() + first_sample_, pass_samples_, tile_x_, tile_y_, tile_triangle_);
    tile_triangle_.first_y = std::max(tile_triangle_.first_y, top);
    tile_triangle_.last_y = std::min(tile_triangle_.last_y, bottom - 1);
    const int count = coverage_.collect(tile_triangle_, visibility_, fragments_.data());
    for (int i = 0; i < count; ++i) {
      const Fragment& f = fragments_[static_cast<std::size_t>(i)];
      const int x = static_cast<int>(f.pixel % tile_size), y = static_cast<int>(f.pixel / tile_size);
      if (!is_in_rectangle(x, y)) continue;
      layers_.push_back({f.samples, f.pixel, t->id, static_cast<std::uint32_t>(layer_depths_.size())});
      for (std::uint64_t left = f.samples; left; left &= left - 1)
        layer_depths_.push_back(depth_at(tile_triangle_, std::countr_zero(left), x, y));
    }
  }
  // The pieces of a clipped triangle come together, and a pixel's layers too. Depth settles what the pieces share.
  std::sort(layers_.begin(), layers_.end(), [](const Layer& p, const Layer& q) {
    if (p.pixel != q.pixel) return p.pixel < q.pixel;
    return p.id != q.id ? p.id < q.id : p.samples < q.samples;
  });
}

Point TileRenderer::point_at(std::uint32_t pixel, std::int32_t id, std::uint64_t samples) const {
  // A surface that owns the whole pixel is shaded at its centre, another at the first sample it owns.
  const std::int32_t x = (tile_x_ + static_cast<std::int32_t>(pixel % tile_size)) * 256;
  const std::int32_t y = (tile_y_ + static_cast<std::int32_t>(pixel / tile_size)) * 256;
  if (samples == all_samples_ && !target_.is_per_sample) return {x + 128, y + 128, id, pixel, samples};
  const SamplePosition s = target_.samples[static_cast<std::size_t>(first_sample_ + std::countr_zero(samples))];
  return {x + s.x, y + s.y, id, pixel, samples};
}

void TileRenderer::add_points(std::uint32_t pixel, std::int32_t id, std::uint64_t samples,
                              std::vector<Point>& points) const {
  if (!target_.is_per_sample) return points.push_back(point_at(pixel, id, samples));
  for (std::uint64_t left = samples; left; left &= left - 1) points.push_back(point_at(pixel, id, left & (~left + 1)));
}

void TileRenderer::find_layer_points(std::vector<Point>& points, std::vector<std::uint32_t>& point_of_layer) const {
  points.clear();
  point_of_layer.resize(layers_.size());
  for (std::size_t i = 0; i < layers_.size();) {
    std::size_t end = i;
    std::uint64_t samples = 0;
    for (; end < layers_.size() && layers_[end].pixel == layers_[i].pixel && layers_[end].id == layers_[i].id; ++end) {
      samples |= layers_[end].samples;
      point_of_layer[end] = static_cast<std::uint32_t>(points.size());
    }
    add_points(layers_[i].pixel, layers_[i].id, samples, points);
    i = end;
  }
}

void TileRenderer::draw_masked() {
  if (sources_[static_cast<std::size_t>(Surface::Masked)].empty()) return;
  std::vector<Point> points;
  std::vector<std::uint32_t> point_of_layer;
  std::vector<std::uint8_t> is_there;
  collect_layers(Surface::Masked, top_, bottom_);
  find_layer_points(points, point_of_layer);
  shader_.test_alpha(points, is_there);

  // What passes enters the same minimum over (depth, id) as the opaque triangles did.
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    std::uint32_t d = layer.first_depth;
    for (std::uint64_t left = layer.samples; left; left &= left - 1, ++d) {
      const int s = std::countr_zero(left);
      std::size_t point = point_of_layer[i];
      if (target_.is_per_sample)
        while (!(points[point].samples >> s & 1)) ++point;
      const std::size_t at = static_cast<std::size_t>(s) * tile_pixels + layer.pixel;
      const float z = layer_depths_[d];
      if (!is_there[point]) continue;
      if (z > visibility_.depth[at] || (z == visibility_.depth[at] && layer.id < visibility_.id[at])) {
        visibility_.depth[at] = z;
        visibility_.id[at] = layer.id;
      }
    }
  }
}

void TileRenderer::find_points() {
  points_.clear();
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel) {
    first_point_[pixel] = static_cast<std::uint32_t>(points_.size());
    if (!is_in_rectangle(static_cast<int>(pixel % tile_size), static_cast<int>(pixel / tile_size))) continue;
    std::uint64_t left = all_samples_;
    while (left) {
      const std::int32_t id = visibility_.id[static_cast<std::size_t>(std::countr_zero(left)) * tile_pixels + pixel];
      std::uint64_t owned = 0;
      for (std::uint64_t rest = left; rest; rest &= rest - 1) {
        const int s = std::countr_zero(rest);
        if (visibility_.id[static_cast<std::size_t>(s) * tile_pixels + pixel] == id) owned |= std::uint64_t{1} << s;
      }
      left &= ~owned;
      if (id != no_triangle) add_points(pixel, id, owned, points_);
    }
  }
  first_point_[tile_pixels] = static_cast<std::uint32_t>(points_.size());
}

void TileRenderer::accumulate() {
  if (!sources_[static_cast<std::size_t>(Surface::Blended)].empty() || target_.sample_color) {
    // In strips, so that the list of layers stays small however deep they lie.
    constexpr int strip = 8;
    for (int y = 0; y < tile_size; y += strip) blend(std::max(y, top_), std::min(y + strip, bottom_));
    return;
  }
  for (std::size_t pixel = 0; pixel < tile_pixels; ++pixel) {
    Linear& sum = sum_[pixel];
    for (std::uint32_t p = first_point_[pixel]; p < first_point_[pixel + 1]; ++p) {
      float weight = 0;
      for (std::uint64_t left = points_[p].samples; left; left &= left - 1)
        weight += weights_[static_cast<std::size_t>(first_sample_ + std::countr_zero(left))];
      sum = sum + colors_[p] * weight;
      covered_[pixel] += static_cast<float>(std::popcount(points_[p].samples));
    }
  }
}

void TileRenderer::blend(int top, int bottom) {
  if (top >= bottom) return;
  std::vector<Point> points;
  std::vector<std::uint32_t> point_of_layer;
  std::vector<Linear> colors;
  collect_layers(Surface::Blended, top, bottom);
  find_layer_points(points, point_of_layer);
  shader_.shade(points, colors, nullptr);

  std::size_t first = 0;
  for (std::uint32_t pixel = static_cast<std::uint32_t>(top * tile_size);
       pixel < static_cast<std::uint32_t>(bottom * tile_size); ++pixel) {
    std::size_t last = first;
    while (last < layers_.size() && layers_[last].pixel == pixel) ++last;
    if (!is_in_rectangle(static_cast<int>(pixel % tile_size), static_cast<int>(pixel / tile_size))) continue;

    // Two pieces of one clipped triangle may share a sample by the snap of their vertices: it must count once.
    bool has_pieces = false;
    for (std::size_t i = first + 1; i < last; ++i) has_pieces = has_pieces || layers_[i].id == layers_[i - 1].id;

    // Every sample starts from the surface that it owns and takes the layers in front of it, the farthest first.
    Linear behind[TileTriangle::max_samples] = {};
    for (int s = 0; s < pass_samples_; ++s) behind[s] = {0, 0, 0, 0};
    for (std::uint32_t p = first_point_[pixel]; p < first_point_[pixel + 1]; ++p)
      for (std::uint64_t left = points_[p].samples; left; left &= left - 1) {
        behind[std::countr_zero(left)] = colors_[p];
        covered_[pixel] += 1;
      }
    struct Over {
      float depth;
      std::int32_t id;
      Linear color;
    };
    std::vector<Over> overs;
    for (int s = 0; s < pass_samples_; ++s) {
      overs.clear();
      for (std::size_t i = first; i < last; ++i) {
        if (!(layers_[i].samples >> s & 1)) continue;
        const auto rank = static_cast<std::uint32_t>(std::popcount(layers_[i].samples & ((std::uint64_t{1} << s) - 1)));
        std::size_t point = point_of_layer[i];
        if (target_.is_per_sample)
          while (!(points[point].samples >> s & 1)) ++point;
        overs.push_back({layer_depths_[layers_[i].first_depth + rank], layers_[i].id, colors[point]});
      }
      std::sort(overs.begin(), overs.end(),
                [](const Over& p, const Over& q) { return p.depth != q.depth ? p.depth < q.depth : p.id > q.id; });
      for (std::size_t i = 0; i < overs.size(); ++i) {
        const bool again = has_pieces && std::any_of(overs.begin(), overs.begin() + static_cast<std::ptrdiff_t>(i),
                                                     [&](const Over& o) { return o.id == overs[i].id; });
        if (!again) behind[s] = overs[i].color + behind[s] * (1 - overs[i].color.a);
      }
      sum_[pixel] = sum_[pixel] + behind[s] * weights_[static_cast<std::size_t>(first_sample_ + s)];
      if (target_.sample_color) store_samples(pixel, s, behind[s]);
    }
    first = last;
  }
}

}  // namespace zoneplate
