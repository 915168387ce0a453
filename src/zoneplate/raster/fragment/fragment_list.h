// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/image/pixel.h"
#include "zoneplate/raster/coverage/centroid.h"
#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// Fragments of one tile that are to be shaded, as a structure of arrays. The fragments of a pixel follow the order of
/// their first samples; those of a span lie close to each other.
struct FragmentList {
  static constexpr int max_samples = 16;
  static constexpr int flush_threshold = 1024;  ///< a list with this many fragments is shaded
  static constexpr int span_capacity = FragmentBatch::group * (max_samples + 1);
  static constexpr int capacity = flush_threshold + span_capacity;

  int count = 0;
  alignas(64) std::int32_t x[capacity], y[capacity];  ///< 1/256 pixel from the image's top-left corner
  alignas(64) std::int32_t id[capacity];              ///< triangle
  alignas(64) std::uint32_t at[capacity];  ///< pixel within the tile + 4096 × the set of samples that take the colour

  static std::uint32_t pixel(std::uint32_t at) { return at & 4095; }
  static std::uint32_t samples(std::uint32_t at) { return at >> 12; }
};

/// The visible primitives of a span of eight pixels.
struct OwnerRow {
  const std::int32_t* id;  ///< of the first pixel's sample 0; the other samples' planes follow sample_stride on
  int sample_count;        ///< at most FragmentList::max_samples
  const std::int32_t *first_summand, *more_summands;  ///< by sample; see CentroidTable
  SamplePosition whole;                               ///< the same
  std::uint32_t pixel;                                ///< the first, within the tile
  std::int32_t x, y;                                  ///< top-left corner of the first pixel, 1/256 pixel
  std::uint32_t drawn;                                ///< a bit for each pixel that is drawn
  bool is_per_sample;  ///< every sample is a fragment of its own, in the order of the samples
};

struct FragmentListKernels : PerIsa<FragmentListKernels> {
  /// Appends one fragment for each triangle that owns samples of a pixel, at the position of CentroidTable. Requires:
  /// capacity for span_capacity more fragments.
  void (*list)(const OwnerRow& row, FragmentList& out);
  /// For each i in order: sum of the pixel of at[i] += color[i] × weight[i]; four floats a pixel.
  void (*add)(const FragmentOutputs& color, const std::uint32_t* at, const float* weight, int count, float* sum);
  /// out = sum / weight, of eight pixels.
  void (*divide)(const float* sum, float weight, Linear8& out);
};

}  // namespace zoneplate
