// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// The points of surfaces at which the visibility of lights is computed, in world space: those of a fragment batch.
struct Receivers {
  static constexpr int capacity = FragmentBatch::padded_capacity;
  int count = 0;

  /// On the triangle, or outside of it where interpolated normals describe a convex surface.
  alignas(64) float position[3][capacity];
  alignas(64) float face[3][capacity];    ///< unit normal of the triangle, towards the viewer's side
  alignas(64) float normal[3][capacity];  ///< unit normal, interpolated from the vertices
  /// A ray that begins at position + face × margin does not meet the triangle's own plane by rounding.
  alignas(64) float margin[capacity];
  alignas(64) std::uint32_t seed[capacity];  ///< hash of the position in the image
};

/// Which part of each light reaches a point.
class LightVisibility {
 public:
  virtual ~LightVisibility() = default;
  /// The part of light k of the frame's lights, in [0, 1]; 0 where the light is below the horizon of `normal`.
  virtual void of_light(int k, const Receivers& receivers, float* visible) const = 0;
  /// Whether of_environment is to be called.
  virtual bool has_occlusion() const = 0;
  /// The cosine-weighted part of the hemisphere about `normal`, in [0, 1], that nothing near occludes.
  virtual void of_environment(const Receivers& receivers, float* visible) const = 0;
};

}  // namespace zoneplate
