// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/math/vec.h"

namespace zoneplate {
class PreparedEnvironment;
}  // namespace zoneplate

#pragma GCC visibility push(default)
namespace zoneplate {

/// The light that reaches a scene from all directions, from infinitely far away.
///
/// Units     linear Rec.709 radiance; `rotation` in radians, counter-clockwise about Scene::up as seen from above.
struct Environment {
  float3 color{0, 0, 0};  ///< multiplies the image where there is one
  /// An index into Scene::images; < 0: the radiance is the same in every direction. An image is equirectangular: its
  /// top row is towards Scene::up, its middle towards +x where +y is up, and a quarter of its width further right +z.
  int image = -1;
  float rotation = 0;  ///< of the image
  bool is_in_camera_space =
      false;           ///< the image turns with the camera: its +y is up in the view, +z towards the viewer
  float strength = 1;  ///< multiplies the radiance
  /// The image, filtered for reflection, which takes precedence over `image`; null: PreparedScene makes it. The type is
  /// not part of the public headers.
  std::shared_ptr<const PreparedEnvironment> map = nullptr;

  /// What multiplies the image; without an image, the radiance.
  float3 factor() const { return strength == 1 ? color : color * strength; }
  bool operator==(const Environment&) const = default;
};

}  // namespace zoneplate
#pragma GCC visibility pop
