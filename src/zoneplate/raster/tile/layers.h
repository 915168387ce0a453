// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/raster/coverage/coverage.h"
#include "zoneplate/raster/tile/job.h"

namespace zoneplate {

/// One triangle over one pixel that is alpha-tested or blended: the samples where it lies in front of the visible
/// surface, and where its depths at them are stored.
struct Layer {
  std::uint64_t samples;
  std::uint32_t pixel;
  std::int32_t id;
  std::uint32_t first_depth;  ///< index into LayerList::depths; the depths follow in the order of the samples
};

/// The layers of a part of a tile, sorted by pixel, triangle and samples, and the fragments to be shaded for them.
///
/// The pieces of a clipped triangle are layers of their own with one id; they share their fragment.
struct LayerList {
  std::vector<Layer> layers;
  std::vector<float> depths;
  std::vector<Fragment> fragments;               ///< one for each pixel and triangle, or each sample and triangle
  std::vector<std::uint32_t> fragment_of_layer;  ///< index of the layer's first fragment
  std::vector<CoveredPixel> covered;             ///< scratch memory of collect_layers

  /// The fragment of layer i at sample s of the pass. Requires: the layer has the sample.
  std::size_t fragment_at(std::size_t i, int s, bool is_per_sample) const {
    std::size_t fragment = fragment_of_layer[i];
    if (is_per_sample)
      while (!(fragments[fragment].samples >> s & 1)) ++fragment;
    return fragment;
  }
};

/// Collects the layers of the mode's triangles over `rect`, from triangle number `first` on, until the list holds
/// RasterCapacity::layer_samples depths; returns the number of the first triangle that is left. `spans`, if not null,
/// has a flag for each span of the tile: pixels of other spans are skipped.
///
/// Requires  materialized blocks.
std::size_t collect_layers(const TileJob& job, AlphaMode mode, std::size_t first, const TileRect& rect,
                           const std::uint8_t* spans, const TileVisibility& visibility, LayerList& list);

/// Fills `fragments` and `fragment_of_layer`.
void collect_layer_fragments(const TileJob& job, bool is_per_sample, LayerList& list);

}  // namespace zoneplate
