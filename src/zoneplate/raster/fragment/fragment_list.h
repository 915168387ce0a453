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
  static constexpr int most_samples = 16;
  static constexpr int enough = 1024;  ///< fragments from which on a list is shaded
  static constexpr int row_room = FragmentBatch::group * (most_samples + 1);
  static constexpr int capacity = enough + row_room;

  int count = 0;
  alignas(64) std::int32_t x[capacity], y[capacity];  ///< 1/256 pixel from the picture's top-left corner
  alignas(64) std::int32_t id[capacity];              ///< triangle
  alignas(64) std::uint32_t at[capacity];  ///< pixel within the tile + 4096 × the set of samples that take the colour

  static std::uint32_t pixel(std::uint32_t at) { return at & 4095; }
  static std::uint32_t samples(std::uint32_t at) { return at >> 12; }
};

/// The visible primitives of a span of eight pixels.
struct OwnerRow {
  const std::int32_t* id;  ///< of the first pixel's sample 0; the other samples' planes follow tile_pixels on
  int sample_count;        ///< at most FragmentList::most_samples
  const std::int32_t *first_place, *more_places;  ///< by sample, as in ShadedPlaces
  std::uint32_t pixel;                            ///< the first, within the tile
  std::int32_t x, y;                              ///< its top-left corner, 1/256 pixel
  std::uint32_t wanted;                           ///< a bit for each pixel that is drawn
  bool is_per_sample;  ///< every sample is a fragment of its own, in the order of the samples
};

struct FragmentListKernels : PerIsa<FragmentListKernels> {
  /// Appends one fragment for each triangle that owns samples of a pixel: at the pixel's centre if it owns all of them,
  /// otherwise where ShadedPlaces puts it. Requires: capacity for row_room more.
  void (*list)(const OwnerRow& row, FragmentList& out);
  /// sum of the pixel of at[i] += color[i] × weight[i], one after the other; four floats a pixel.
  void (*add)(const FragmentOutputs& color, const std::uint32_t* at, const float* weight, int count, float* sum);
  /// out = sum / weight, of eight pixels.
  void (*divide)(const float* sum, float weight, Linear8& out);
};

}  // namespace zoneplate
