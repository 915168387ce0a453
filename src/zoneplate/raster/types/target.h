// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/image/display_transform.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/raster/types/sampling.h"
#include "zoneplate/raster/types/viewport.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {

/// The planes that rasterization writes to. Every plane that is not null has the size of the rectangle and is
/// initialised: pixels without triangles keep their values (0 in `color` and `coverage`). `display8` is written
/// completely, with the background.
struct Target {
  Viewport viewport;                        ///< the whole image
  int x = 0, y = 0, width = 0, height = 0;  ///< the rectangle that is drawn, in pixels of the image

  const Plane<std::uint8_t>* pixel_mask = nullptr;  ///< pixels that are not 0 here are drawn; null: all

  SamplePattern samples;
  std::vector<float> weights;          ///< by sample; empty: all equal
  bool keeps_hidden = false;           ///< bins keep hidden samples, for methods that draw in order
  bool is_per_sample = false;          ///< shade every sample by itself
  AlphaTest alpha = AlphaTest::Pixel;  ///< at rate *surface*
  Centroid centroid = Centroid::Mean;  ///< the same
  float spacing = 1;                   ///< the texture footprint of a fragment, in pixels

  LinearImage* color = nullptr;    ///< weighted mean of the samples, premultiplied
  Rgba8Image* display8 = nullptr;  ///< display-referred, by `display_transform`; both or neither
  const DisplayTransform* display_transform = nullptr;

  // The data of a pixel come from one point of the surface that owns its nearest sample: at the pixel's centre if the
  // surface owns all samples, otherwise where it is shaded for that sample; or always at the sample itself.
  bool has_data_at_samples = false;
  Plane<SamplePosition>* data_position = nullptr;  ///< position of that point in the pixel
  Plane<float>* reversed_depth = nullptr;
  Plane<float3>* normal = nullptr;
  Plane<float3>* albedo = nullptr;
  Plane<float2>* uv = nullptr;
  Plane<float>*mip_level = nullptr, *anisotropy = nullptr;
  Plane<std::uint32_t>* instance = nullptr;
  Plane<std::uint32_t>* material = nullptr;
  Plane<std::uint32_t>* primitive = nullptr;

  Plane<float>* coverage = nullptr;

  std::vector<LinearImage>* sample_color = nullptr;   ///< by sample
  std::vector<Plane<float>>* sample_depth = nullptr;  ///< only together with `sample_triangle`
  std::vector<Plane<std::uint32_t>>* sample_triangle = nullptr;
  /// Where visibility alone is stored: a sample keeps the triangle that an earlier call has stored, unless one of this
  /// call is nearer. The triangles of several calls, in ascending order of their ids, then have the planes of one call.
  bool keeps_nearer = false;

  /// Whether there are data planes by pixel.
  bool stores_data() const {
    return data_position || reversed_depth || stores_shaded_data() || instance || material || primitive;
  }
  /// Whether the target stores results of shading other than colours.
  bool stores_shaded_data() const { return normal || albedo || uv || stores_footprint(); }
  bool stores_footprint() const { return mip_level || anisotropy; }
  bool stores_samples() const { return sample_color || sample_triangle; }
  /// Whether only the triangles and depths of samples are stored: then no fragment is shaded.
  bool stores_visibility_alone() const {
    return sample_triangle && !(color || display8 || sample_color || reversed_depth || stores_shaded_data() ||
                                instance || material || primitive || coverage);
  }

  static constexpr std::uint32_t no_id = 0xffffffffu;  ///< in id planes, for pixels without a surface
};

}  // namespace zoneplate
