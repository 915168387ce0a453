// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/raster/tile/opaque.h"

namespace zoneplate {

/// The nearest opaque or alpha-tested surface of a pixel, over all passes so far.
struct NearestSurface {
  float depth = 0;  ///< reversed, at the nearest of its samples
  std::int32_t id = no_primitive;
  SamplePosition sample;                 ///< the nearest sample
  SamplePosition position;               ///< where the surface is shaded that owns this sample
  std::int32_t first_id = no_primitive;  ///< the owner of the pixel's first covered sample
  int first_owns = 0;                    ///< the number of samples that first_id owns
};

/// The contents of the target's data planes: for each pixel, the data of one point of its nearest surface
/// (render/frame.h).
struct TileData {
  std::vector<NearestSurface> nearest;  ///< by pixel
  FragmentData shaded;                  ///< of the fragments of a pass
  FragmentData pixels;                  ///< of the nearest surfaces, by pixel
  std::vector<Fragment> fragments;      ///< scratch memory of write_data
};

/// Updates `nearest` by the fragments of a pass, in the order of visibility. `is_shaded`: `shaded` holds their data.
void collect_nearest_surfaces(const TileJob& job, const TileVisibility& visibility, const OpaqueFragments& opaque,
                              bool is_shaded, TileData& data);

/// Writes the data planes from `nearest`. A surface that owns all samples of a pixel is taken at the pixel's centre,
/// unless the target has data at samples.
/// Fragments are shaded only where the target stores results of shading other than colours, and only those whose data
/// the passes have not shaded: `is_shaded` as in collect_nearest_surfaces.
void write_data(const TileJob& job, FragmentBatcher& batcher, bool is_shaded, TileData& data);

}  // namespace zoneplate
