// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/job.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace zoneplate {
namespace {

/// Sorts triangles into 64 buckets of their nearest depth, so that hidden ones are rejected by whole blocks. Any order
/// gives the same image, so that a coarse one suffices.
void sort_nearest_first(std::vector<const Triangle*>& list, std::vector<const Triangle*>& sorted) {
  constexpr std::size_t buckets = 64;
  if (list.size() < 2) return;
  float low = list[0]->z_high, high = low;
  for (const Triangle* t : list) low = std::min(low, t->z_high), high = std::max(high, t->z_high);
  const float scale = high > low ? static_cast<float>(buckets - 1) / (high - low) : 0;
  const auto bucket = [&](const Triangle* t) { return static_cast<std::size_t>((high - t->z_high) * scale); };
  std::uint32_t first[buckets + 1] = {};
  for (const Triangle* t : list) ++first[std::min(bucket(t), buckets - 1) + 1];
  for (std::size_t i = 0; i < buckets; ++i) first[i + 1] += first[i];
  sorted.resize(list.size());
  for (const Triangle* t : list) sorted[first[std::min(bucket(t), buckets - 1)]++] = t;
  list.swap(sorted);
}

}  // namespace

TileSetup::TileSetup(const ProjectedDraws& draws, const Bins& binned, const FragmentShader& fragment_shader,
                     const RasterRules& raster_rules, const Target& planes, std::optional<float> brightest)
    : projected(draws),
      bins(binned),
      shader(fragment_shader),
      target(planes),
      coverage(CoverageKernels::of()),
      resolve(ResolveKernels::of()),
      fragment_lists(FragmentListKernels::of()),
      rules(raster_rules),
      min_transmittance(transmittance_cutoff(brightest ? *brightest : fragment_shader.brightest())),
      centroids(planes.samples, planes.is_per_sample ? Centroid::First : planes.centroid),
      weights(planes.weights) {
  if (weights.empty()) weights.assign(target.samples.size(), 1.0f);
  assert(weights.size() == target.samples.size());
  for (const float w : weights) weight_sum += w;
  set_weights_.resize(std::size_t{1} << std::min(samples(), max_tabulated_samples));
  for (std::uint32_t set = 0; set < set_weights_.size(); ++set) set_weights_[set] = weight_of(set, 0);
  assert(max_pass_samples() <= TileTriangle::max_samples);
}

int TileSetup::max_pass_samples() const {
  return target.is_per_sample ? std::min(samples(), samples_per_pass) : samples();
}

float TileSetup::weight_of(std::uint64_t set, int first) const {
  float weight = 0;
  for (; set; set &= set - 1) weight += weights[static_cast<std::size_t>(first + std::countr_zero(set))];
  return weight;
}

bool TileSetup::stores_color_alone() const {
  const bool has_passes = samples() > max_pass_samples();
  return !target.stores_data() && !target.coverage && !target.pixel_mask && !target.sample_triangle && !has_passes;
}

bool TileJob::make_triangle_in(const Triangle& t, const TileRect& rect, TileTriangle& out) const {
  if (t.max_y - y < rect.top || t.min_y - y >= rect.bottom) return false;
  if (t.max_x - x < rect.left || t.min_x - x >= rect.right) return false;
  make_triangle(t, out);
  out.first_x = std::max(out.first_x, rect.left);
  out.last_x = std::min(out.last_x, rect.right - 1);
  out.first_y = std::max(out.first_y, rect.top);
  out.last_y = std::min(out.last_y, rect.bottom - 1);
  return true;
}

void TileJob::add_fragments(std::uint32_t pixel, std::int32_t id, std::uint64_t samples, bool is_per_sample,
                            std::vector<Fragment>& out) const {
  if (!is_per_sample) return out.push_back(fragment_at(pixel, id, samples));
  for (std::uint64_t left = samples; left; left &= left - 1) {
    const auto s = static_cast<std::size_t>(pass.first + std::countr_zero(left));
    out.push_back(fragment_at(pixel, id, left & (~left + 1), setup.target.samples[s]));
  }
}

FragmentSpan TileJob::span_at(std::uint32_t pixel, std::int32_t id) const {
  const auto px = static_cast<std::int32_t>(pixel % tile_size), py = static_cast<std::int32_t>(pixel / tile_size);
  const SamplePosition whole = setup.centroids.whole;
  return {(x + px) * 256 + whole.x, (y + py) * 256 + whole.y, id, pixel};
}

void begin_tile(std::size_t tile, TileJob& job) {
  const Bins& bins = job.setup.bins;
  const Target& target = job.setup.target;
  job.tile = tile;
  job.x = (bins.first_column + static_cast<int>(tile) % bins.columns) * tile_size;
  job.y = (bins.first_row + static_cast<int>(tile) / bins.columns) * tile_size;
  job.drawn = {.left = std::max(target.x - job.x, 0),
               .top = std::max(target.y - job.y, 0),
               .right = std::min(target.x + target.width - job.x, tile_size),
               .bottom = std::min(target.y + target.height - job.y, tile_size)};
  for (std::size_t mode = 0; mode < job.triangles.size(); ++mode) {
    std::vector<const Triangle*>& list = job.triangles[mode];
    list.clear();
    for (const Bins::Worker& worker : bins.workers)
      for (const std::uint32_t t : worker.tiles[tile][mode]) list.push_back(&worker.triangles[t]);
  }
  sort_nearest_first(job.triangles[static_cast<std::size_t>(AlphaMode::Opaque)], job.sorted);
}

void begin_pass(int first, int count, TileJob& job) {
  job.pass = {first, count, count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1};
}

}  // namespace zoneplate
