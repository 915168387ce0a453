// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/base/aligned_array.h"
#include "zoneplate/raster/coverage/coverage.h"
#include "zoneplate/raster/tile/job.h"

namespace zoneplate {

/// The memory of a tile's visibility: TileVisibility with the planes that it refers to.
class VisibilityBuffer : public TileVisibility {
 public:
  explicit VisibilityBuffer(int max_samples);
  VisibilityBuffer(const VisibilityBuffer&) = delete;  // it refers to itself

 private:
  AlignedArray<float> depth_storage_;
  AlignedArray<std::int32_t> id_storage_;
  alignas(64) float block_min_depth_storage_[blocks];
  std::int32_t block_primitive_storage_[blocks];
};

/// Clears the tile and draws the job's opaque triangles, those of SampleBins included.
void rasterize_opaque(const TileJob& job, TileVisibility& visibility);

/// Draws the samples of small triangles (raster/geometry/small_triangles.h), which were found before the tile began.
void rasterize_small(const TileJob& job, TileVisibility& visibility);

/// Writes the depths and triangle ids of the samples to the target's planes. No fragment is shaded for them.
///
/// Requires  materialized blocks; one pass of all samples.
void write_visibility(const TileJob& job, const TileVisibility& visibility);

}  // namespace zoneplate
