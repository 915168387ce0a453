// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// The points of surfaces at which the visibility of lights is computed, in world space: those of a fragment batch.
struct Receivers {
  static constexpr int capacity = FragmentBatch::padded_capacity;
  int count = 0;
  /// Light from below the horizon passes through the surfaces; else of_light may give 0 for it.
  bool is_transmissive = false;
  bool is_ground = false;  ///< on the plane under the scene
  /// FragmentBatch::coverage, set where LightVisibility::needs_coverage is true.
  const float* coverage = nullptr;
  /// How often each receiver's numbers of rays are halved, rounding up, while they are greater than min_rays; null:
  /// never.
  const std::uint8_t* halvings = nullptr;
  static constexpr int min_rays = 8;
  /// A number of rays after that many halvings.
  static constexpr int halved(int rays, int times) {
    for (; times > 0 && rays > min_rays; --times) rays = (rays + 1) / 2;
    return rays;
  }

  /// On the triangle, or outside of it where interpolated normals describe a convex surface.
  alignas(64) float position[3][capacity];
  alignas(64) float face[3][capacity];    ///< unit normal of the triangle, towards the viewer's side
  alignas(64) float normal[3][capacity];  ///< unit normal, interpolated from the vertices
  /// A ray that begins at position + face × margin does not meet the triangle's own plane by rounding.
  alignas(64) float margin[capacity];
  alignas(64) std::int32_t x[capacity], y[capacity];  ///< in the image, as in FragmentBatch
  alignas(64) std::uint32_t seed[capacity];           ///< hash of x and y
  alignas(64) std::uint32_t surface[capacity];        ///< the instance; 0 on the ground
  /// Half of the change of the position from one pixel to the next, shortened so that position ± dx ± dy stay within
  /// the triangle; zero where LightVisibility::needs_footprint is false.
  alignas(64) float dx[3][capacity], dy[3][capacity];
};

/// The square of the sine of the angle between the normals of receiver i.
inline float bend_of(const Receivers& r, int i) {
  const float cosine = r.face[0][i] * r.normal[0][i] + r.face[1][i] * r.normal[1][i] + r.face[2][i] * r.normal[2][i];
  return std::max(1 - cosine * cosine, 0.0f);
}

/// A pixel, from the top-left corner of the image; it may lie outside of the image.
struct PixelPosition {
  std::int32_t x, y;
};

/// Which part of each light reaches a point.
class LightVisibility {
 public:
  virtual ~LightVisibility() = default;
  /// The part of light k of the frame's lights, in [0, 1]; 0 where the light is below the horizon of `normal`, unless
  /// the receivers are transmissive: then as seen from their other side.
  virtual void of_light(int k, const Receivers& receivers, float* visible) const = 0;
  /// Whether of_light averages over the pixel: it then reads dx and dy.
  virtual bool needs_footprint() const = 0;
  /// Whether of_light or of_environment reads the receivers' coverage.
  virtual bool needs_coverage() const { return false; }
  /// Whether of_environment is to be called.
  virtual bool has_occlusion() const = 0;
  /// The cosine-weighted part of the hemisphere about `normal`, in [0, 1], that nothing near occludes.
  virtual void of_environment(const Receivers& receivers, float* visible) const = 0;
};

}  // namespace zoneplate
