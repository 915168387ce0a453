// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "zoneplate/raster/coverage/alpha_coverage.h"
#include "zoneplate/raster/tile/layers.h"
#include "zoneplate/raster/tile/visibility.h"

namespace zoneplate {

/// Draws the job's alpha-tested triangles into a tile whose opaque triangles are drawn.
///
/// The samples that pass the test compete by the same order over (depth, id) as opaque ones, so that the order of
/// drawing changes nothing. If there are more layers than RasterCapacity::layer_samples, they are drawn in parts, and
/// the triangles of each part are tested against the visibility before the first part.
class AlphaTester {
 public:
  explicit AlphaTester(const TileSetup& setup);

  /// `batcher` shades with the setup's shader.
  void rasterize(const TileJob& job, FragmentBatcher& batcher, TileVisibility& visibility);

 private:
  void draw_layers(const TileJob& job, FragmentBatcher& batcher, TileVisibility& visibility);
  void collect_passing_samples(const TileJob& job, FragmentBatcher& batcher);

  AlphaDigits digits_;
  FragmentBatcher digit_batcher_;
  LayerList list_;
  std::vector<std::uint8_t> passes_;
  std::vector<std::uint64_t> passing_samples_;  ///< by fragment: the samples at which the alpha test passes
  std::unique_ptr<VisibilityBuffer> before_;    ///< made when the first tile needs several parts
};

}  // namespace zoneplate
