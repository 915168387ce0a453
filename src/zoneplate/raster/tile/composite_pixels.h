// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/raster/tile/layers.h"

namespace zoneplate {

/// The layers of one pixel: a part of LayerList::layers, or, where the pixel is deep, more than fit there.
struct PixelLayers {
  std::uint32_t pixel;
  std::size_t first, last;
  bool is_deep;
  bool is_empty() const { return first == last && !is_deep; }
};

/// A layer of one sample, with its colour.
struct SampleLayer {
  float depth;
  std::int32_t id;
  Linear color;
};

/// Composites the layers of one sample over `behind`, in the order of (depth, id); `layers` are sorted. Of several
/// pieces of one triangle (`has_pieces`) the nearest counts.
void composite_sample(std::vector<SampleLayer>& layers, bool has_pieces, float transmittance_cutoff, Linear& behind);

/// Composites the transparent fragments of pixels, sample by sample, in exact depth order.
///
/// Exact     at every sample the fragments are ordered by (depth, triangle id), a total order; those that lie behind
///           TileSetup::min_transmittance are left out. The route by which a pixel is drawn changes no bit.
/// Source    Carpenter, The A-buffer, SIGGRAPH 1984.
class PixelCompositor {
 public:
  /// Collects and shades the layers over `rect` and calls composite(PixelLayers) for every drawn pixel of it, also for
  /// those without layers. `spans`, if not null, has a flag for each span of the tile: pixels of other spans have no
  /// layers. A rectangle with more layers than RasterCapacity::layer_samples is halved, down to a pixel, which is
  /// deep if it still has more.
  ///
  /// Requires  materialized blocks.
  template <class Composite>
  void for_pixels(const TileJob& job, const TileRect& rect, const std::uint8_t* spans, const TileVisibility& visibility,
                  FragmentBatcher& batcher, Composite composite);

  /// Composites the pixel's layers over `behind`, which holds a colour for each sample of the pass, in place. To be
  /// called by `composite` of for_pixels.
  void composite(const TileJob& job, const PixelLayers& layers, const TileVisibility& visibility,
                 FragmentBatcher& batcher, Linear* behind);

 private:
  /// A layer of one sample of a deep pixel, with all samples of the pixel where the triangle is visible.
  struct Peel {
    float depth;
    std::int32_t id;
    std::uint64_t samples;
    /// Nearer, or as near and drawn earlier.
    bool operator<(const Peel& o) const { return depth != o.depth ? depth > o.depth : id < o.id; }
  };

  void composite_collected(const TileJob& job, std::size_t first, std::size_t last, Linear* behind);
  void peel(const TileJob& job, const TileVisibility& visibility, FragmentBatcher& batcher, std::uint32_t pixel,
            int sample, Linear& behind);
  void collect_next_layers(const TileJob& job, const TileVisibility& visibility, std::uint32_t pixel, int sample,
                           const Peel& last);
  Peel layer_of(const TileJob& job, const TileVisibility& visibility, std::span<const Triangle* const> pieces,
                std::uint32_t pixel, int sample);

  LayerList list_;
  std::vector<Linear> colors_;  ///< of list_.fragments
  std::vector<SampleLayer> overs_;
  std::vector<Peel> peeled_;
};

template <class Composite>
void PixelCompositor::for_pixels(const TileJob& job, const TileRect& rect, const std::uint8_t* spans,
                                 const TileVisibility& visibility, FragmentBatcher& batcher, Composite composite) {
  if (rect.is_empty()) return;
  const std::size_t triangles = job.triangles_of(AlphaMode::Blend).size();
  const int width = rect.right - rect.left, height = rect.bottom - rect.top;
  if (collect_layers(job, AlphaMode::Blend, 0, rect, spans, visibility, list_) == triangles) {
    collect_layer_fragments(job, job.setup.target.is_per_sample, list_);
    batcher.shade(list_.fragments, colors_, nullptr);
    std::size_t first = 0;
    for (int y = rect.top; y < rect.bottom; ++y)
      for (int x = rect.left; x < rect.right; ++x) {
        const auto pixel = static_cast<std::uint32_t>(y * tile_size + x);
        std::size_t last = first;
        while (last < list_.layers.size() && list_.layers[last].pixel == pixel) ++last;
        if (job.draws(x, y)) composite(PixelLayers{pixel, first, last, false});
        first = last;
      }
  } else if (width == 1 && height == 1) {
    composite(PixelLayers{static_cast<std::uint32_t>(rect.top * tile_size + rect.left), 0, 0, true});
  } else {
    TileRect half = rect, other = rect;
    if (height > 1) {
      half.bottom = other.top = (rect.top + rect.bottom) / 2;
    } else {
      half.right = other.left = (rect.left + rect.right) / 2;
    }
    for_pixels(job, half, spans, visibility, batcher, composite);
    for_pixels(job, other, spans, visibility, batcher, composite);
  }
}

}  // namespace zoneplate
