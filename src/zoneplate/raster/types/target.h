#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/raster/types/sampling.h"
#include "zoneplate/raster/types/viewport.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {

/// Where rasterizing puts its results. Every plane that is not null has the size of the rectangle, and holds what is
/// to stay where no triangle is: `color` and `coverage` 0. `shown` is written whole, the background too.
struct Target {
  Viewport viewport;                        ///< the whole picture
  int x = 0, y = 0, width = 0, height = 0;  ///< the rectangle that is drawn, in the picture's pixels

  const Plane<std::uint8_t>* pixel_mask = nullptr;  ///< pixels that are not 0 here are drawn; null: all

  SamplePattern samples;
  std::vector<float> weights;          ///< one a sample; empty: all equal
  bool keeps_hidden = false;           ///< bins keep fragments behind others too, for those who draw in order
  bool is_per_sample = false;          ///< shade every sample by itself
  AlphaTest alpha = AlphaTest::Pixel;  ///< where not every sample is shaded
  Centroid centroid = Centroid::Mean;  ///< the same
  float spacing = 1;                   ///< the footprint of a shaded point, in pixels

  LinearImage* color = nullptr;  ///< weighted mean of the samples, premultiplied
  Rgba8Image* shown = nullptr;   ///< the same as `presenter` shows it; both or neither
  const DisplayTransform* presenter = nullptr;

  // Of each pixel one point of the surface that owns its nearest sample: the pixel's centre if it owns all samples,
  // else where it is shaded for that one: at the place that `centroid` gives, or at the sample if every sample is
  // shaded.
  Plane<SamplePosition>* place = nullptr;  ///< the point's
  Plane<float>* reversed_depth = nullptr;
  Plane<float3>* normal = nullptr;
  Plane<float3>* albedo = nullptr;
  Plane<float2>* uv = nullptr;
  Plane<std::uint32_t>* instance = nullptr;
  Plane<std::uint32_t>* material = nullptr;
  Plane<std::uint32_t>* primitive = nullptr;

  Plane<float>* coverage = nullptr;

  std::vector<LinearImage>* sample_color = nullptr;   ///< by sample
  std::vector<Plane<float>>* sample_depth = nullptr;  ///< only beside `sample_triangle`
  std::vector<Plane<std::uint32_t>>* sample_triangle = nullptr;

  /// True if there are planes of data by pixel.
  bool wants_data() const {
    return place || reversed_depth || normal || albedo || uv || instance || material || primitive;
  }
  bool stores_samples() const { return sample_color || sample_triangle; }
  /// True if nothing is wanted but which triangle owns each sample, and at which depth: then nothing is shaded.
  bool stores_visibility_alone() const {
    return sample_triangle && !(color || shown || sample_color || reversed_depth || normal || albedo || uv ||
                                instance || material || primitive || coverage);
  }

  static constexpr std::uint32_t no_id = 0xffffffffu;  ///< in an id plane, where nothing is
};

}  // namespace zoneplate
