// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/layers.h"

#include <algorithm>
#include <bit>

#include "zoneplate/base/deadline.h"

namespace zoneplate {

std::size_t collect_layers(const TileJob& job, AlphaMode mode, std::size_t first, const TileRect& rect,
                           const std::uint8_t* spans, const TileVisibility& visibility, LayerList& list) {
  const std::vector<const Triangle*>& triangles = job.triangles_of(mode);
  list.layers.clear();
  list.depths.clear();
  list.covered.resize(tile_pixels);
  TileTriangle triangle;
  std::size_t number = first;
  for (; number < triangles.size(); ++number) {
    const Triangle& t = *triangles[number];
    // The pieces of a clipped triangle follow each other, and are shaded together.
    const bool is_full = list.depths.size() >= job.setup.rules.capacity.layer_samples;
    if (is_full && number > first && t.id != triangles[number - 1]->id) break;
    if (number % deadline_stride == 0) check_deadline();
    if (!job.make_triangle_in(t, rect, triangle)) continue;
    const int count = job.setup.coverage.collect(triangle, visibility, list.covered.data());
    for (int i = 0; i < count; ++i) {
      const CoveredPixel& c = list.covered[static_cast<std::size_t>(i)];
      const int x = static_cast<int>(c.pixel % tile_size), y = static_cast<int>(c.pixel / tile_size);
      if (!rect.contains(x, y) || !job.draws(x, y) || (spans && !spans[c.pixel / 8])) continue;
      list.layers.push_back({c.samples, c.pixel, t.id, static_cast<std::uint32_t>(list.depths.size())});
      for (std::uint64_t left = c.samples; left; left &= left - 1)
        list.depths.push_back(depth_at(triangle, std::countr_zero(left), x, y));
    }
  }
  // The pieces of a clipped triangle become neighbours, and so do a pixel's layers. Depth decides which piece a sample
  // belongs to that two of them share.
  std::sort(list.layers.begin(), list.layers.end(), [](const Layer& p, const Layer& q) {
    if (p.pixel != q.pixel) return p.pixel < q.pixel;
    return p.id != q.id ? p.id < q.id : p.samples < q.samples;
  });
  return number;
}

void collect_layer_fragments(const TileJob& job, bool is_per_sample, LayerList& list) {
  const std::vector<Layer>& layers = list.layers;
  list.fragments.clear();
  list.fragment_of_layer.resize(layers.size());
  for (std::size_t i = 0; i < layers.size();) {
    std::size_t end = i;
    std::uint64_t samples = 0;
    for (; end < layers.size() && layers[end].pixel == layers[i].pixel && layers[end].id == layers[i].id; ++end) {
      samples |= layers[end].samples;
      list.fragment_of_layer[end] = static_cast<std::uint32_t>(list.fragments.size());
    }
    job.add_fragments(layers[i].pixel, layers[i].id, samples, is_per_sample, list.fragments);
    i = end;
  }
}

}  // namespace zoneplate
