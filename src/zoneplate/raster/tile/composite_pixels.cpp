// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/composite_pixels.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "zoneplate/base/deadline.h"

namespace zoneplate {

void composite_sample(std::vector<SampleLayer>& layers, bool has_pieces, float transmittance_cutoff, Linear& behind) {
  if (layers.empty()) return;
  std::ranges::sort(layers, [](const SampleLayer& p, const SampleLayer& q) {
    return p.depth != q.depth ? p.depth > q.depth : p.id < q.id;
  });
  TransparentStack stack;
  for (std::size_t i = 0; i < layers.size() && stack.transmittance > transmittance_cutoff; ++i) {
    const auto is_same = [&](const SampleLayer& o) { return o.id == layers[i].id; };
    const bool again = has_pieces && std::ranges::any_of(std::span(layers).first(i), is_same);
    if (!again) stack.composite_under(layers[i].color, transmittance_cutoff);
  }
  behind = stack.over(behind);
}

void PixelCompositor::composite(const TileJob& job, const PixelLayers& layers, const TileVisibility& visibility,
                                FragmentBatcher& batcher, Linear* behind) {
  if (!layers.is_deep) return composite_collected(job, layers.first, layers.last, behind);
  for (int s = 0; s < job.pass.count; ++s) peel(job, visibility, batcher, layers.pixel, s, behind[s]);
}

void PixelCompositor::composite_collected(const TileJob& job, std::size_t first, std::size_t last, Linear* behind) {
  const std::vector<Layer>& layers = list_.layers;
  const float least = job.setup.min_transmittance;
  // Two pieces of one clipped triangle may share a sample because their vertices are snapped: the triangle counts once.
  bool has_pieces = false;
  for (std::size_t i = first + 1; i < last; ++i) has_pieces = has_pieces || layers[i].id == layers[i - 1].id;
  for (int s = 0; s < job.pass.count; ++s) {
    overs_.clear();
    for (std::size_t i = first; i < last; ++i) {
      if (!(layers[i].samples >> s & 1)) continue;
      const auto rank = static_cast<std::uint32_t>(std::popcount(layers[i].samples & ((std::uint64_t{1} << s) - 1)));
      const std::size_t fragment = list_.fragment_at(i, s, job.setup.target.is_per_sample);
      overs_.push_back({list_.depths[layers[i].first_depth + rank], layers[i].id, colors_[fragment]});
    }
    composite_sample(overs_, has_pieces, least, behind[s]);
  }
}

// Depth peeling of one sample of a deep pixel: its layers are found from near to far, RasterCapacity::layer_samples
// at a time, until the transmittance is spent.
//
// Source: Everitt, Interactive Order-Independent Transparency, 2001; several layers a pass: Bavoil and Myers, Order
// Independent Transparency with Dual Depth Peeling, 2008.
void PixelCompositor::peel(const TileJob& job, const TileVisibility& visibility, FragmentBatcher& batcher,
                           std::uint32_t pixel, int sample, Linear& behind) {
  const float least = job.setup.min_transmittance;
  TransparentStack stack;
  Peel last{std::numeric_limits<float>::infinity(), -1, 0};
  bool has_any = false;
  while (stack.transmittance > least) {
    collect_next_layers(job, visibility, pixel, sample, last);
    if (peeled_.empty()) break;
    has_any = true;
    list_.fragments.clear();
    for (const Peel& layer : peeled_)
      list_.fragments.push_back(job.setup.target.is_per_sample
                                    ? job.fragment_at(pixel, layer.id, std::uint64_t{1} << sample)
                                    : job.fragment_at(pixel, layer.id, layer.samples));
    batcher.shade(list_.fragments, colors_, nullptr);
    for (const Linear& color : colors_) stack.composite_under(color, least);
    last = peeled_.back();
  }
  if (has_any) behind = stack.over(behind);
}

/// peeled_: the nearest layers of a sample behind `last`, at most RasterCapacity::layer_samples of them, in their
/// order.
void PixelCompositor::collect_next_layers(const TileJob& job, const TileVisibility& visibility, std::uint32_t pixel,
                                          int sample, const Peel& last) {
  const std::vector<const Triangle*>& triangles = job.triangles_of(AlphaMode::Blend);
  const std::size_t most = std::max<std::size_t>(job.setup.rules.capacity.layer_samples, 1);
  const auto keep_nearest = [&] {
    if (peeled_.size() <= most) return;
    std::nth_element(peeled_.begin(), peeled_.begin() + static_cast<std::ptrdiff_t>(most), peeled_.end());
    peeled_.resize(most);
  };
  peeled_.clear();
  for (std::size_t number = 0, end = 0; number < triangles.size(); number = end) {
    while (end < triangles.size() && triangles[end]->id == triangles[number]->id) ++end;
    if (number % deadline_stride == 0) check_deadline();
    const Peel layer = layer_of(job, visibility, std::span(triangles).subspan(number, end - number), pixel, sample);
    if (!(layer.samples >> sample & 1) || !(last < layer)) continue;
    peeled_.push_back(layer);
    if (peeled_.size() >= 2 * most) keep_nearest();
  }
  keep_nearest();
  std::sort(peeled_.begin(), peeled_.end());
}

/// The pixel's layer of a triangle, which is given by its pieces: all its samples, and its depth at one of them.
PixelCompositor::Peel PixelCompositor::layer_of(const TileJob& job, const TileVisibility& visibility,
                                                std::span<const Triangle* const> pieces, std::uint32_t pixel,
                                                int sample) {
  const int x = static_cast<int>(pixel % tile_size), y = static_cast<int>(pixel / tile_size);
  Peel layer{-std::numeric_limits<float>::infinity(), pieces[0]->id, 0};
  TileTriangle triangle;
  for (const Triangle* piece : pieces) {
    if (!job.make_triangle_in(*piece, {x, y, x + 1, y + 1}, triangle)) continue;
    const int count = job.setup.coverage.collect(triangle, visibility, list_.covered.data());
    for (int i = 0; i < count; ++i) {
      const CoveredPixel& c = list_.covered[static_cast<std::size_t>(i)];
      if (c.pixel != pixel) continue;
      layer.samples |= c.samples;
      if (c.samples >> sample & 1) layer.depth = std::max(layer.depth, depth_at(triangle, sample, x, y));
    }
  }
  return layer;
}

}  // namespace zoneplate
