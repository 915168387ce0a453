// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/vec.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The light that reaches a scene from all directions, from infinitely far away.
///
/// Without an image the environment has one colour in every direction. The renderer draws that case only: see
/// `constant_radiance`.
/// Units     linear Rec.709 radiance; `rotation` in radians, counter-clockwise about Scene::up as seen from above.
struct Environment {
  float3 color{0, 0, 0};  ///< multiplies the image where there is one
  int image = -1;         ///< index into Scene::images: equirectangular, its top row towards Scene::up; < 0: none
  float rotation = 0;     ///< of the image
  float strength = 1;     ///< multiplies the radiance

  /// The radiance of an environment without an image.
  ///
  /// Errors    ErrorKind::Input where there is an image: image-based lighting is not implemented.
  float3 constant_radiance() const;
  bool operator==(const Environment&) const = default;
};

}  // namespace zoneplate
#pragma GCC visibility pop
