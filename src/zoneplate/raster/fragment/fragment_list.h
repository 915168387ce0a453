#pragma once

#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/image/pixel.h"
#include "zoneplate/raster/coverage/centroid.h"
#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// Surface points of one tile that are to be shaded, structure of arrays; those of a pixel in the order of their first
/// samples, those of eight neighbouring pixels of a row not far from each other.
struct FragmentList {
  static constexpr int most_samples = 16;
  static constexpr int enough = 1024;  ///< points that are worth being shaded together
  static constexpr int row_room = FragmentBatch::group * (most_samples + 1);
  static constexpr int capacity = enough + row_room;

  int count = 0;
  alignas(64) std::int32_t x[capacity], y[capacity];  ///< 1/256 pixel from the picture's top-left corner
  alignas(64) std::int32_t id[capacity];              ///< triangle
  alignas(64) std::uint32_t at[capacity];  ///< pixel within the tile + 4096 × a bit for each sample it colours

  static std::uint32_t pixel(std::uint32_t at) { return at & 4095; }
  static std::uint32_t samples(std::uint32_t at) { return at >> 12; }
};

/// The owners of eight neighbouring pixels of a row.
struct OwnerRow {
  const std::int32_t* id;  ///< of the first pixel's sample 0; the other samples' planes follow tile_pixels on
  int sample_count;        ///< at most FragmentList::most_samples
  const std::int32_t *first_place, *more_places;  ///< of the samples, as in ShadedPlaces
  std::uint32_t pixel;                            ///< the first, within the tile
  std::int32_t x, y;                              ///< its top-left corner, 1/256 pixel
  std::uint32_t wanted;                           ///< a bit for each pixel that is drawn
  bool is_per_sample;                             ///< every sample is a point of its own, in the order of the samples
};

struct FragmentListKernels : PerIsa<FragmentListKernels> {
  /// Adds one point for each triangle that owns samples of a pixel: at the pixel's centre if it owns all of them, else
  /// where their ShadedPlaces say. Requires  room for row_room.
  void (*list)(const OwnerRow& row, FragmentList& out);
  /// sum of the pixel of at[i] += color[i] × weight[i], one after the other; four floats a pixel.
  void (*add)(const FragmentOutputs& color, const std::uint32_t* at, const float* weight, int count, float* sum);
  /// out = sum / weight, of eight pixels.
  void (*divide)(const float* sum, float weight, Linear8& out);
};

}  // namespace zoneplate
