// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/scene/light.h"

namespace zoneplate {

/// The lights of a scene that has none, and no metallic-roughness material (else: render/lighting.h): three directional
/// lights that follow the camera.
///
/// key   from above on the left, 40° off the view axis: it gives form and nearly all of the light;
/// fill  from the right, a little below: a sixth of the key, so that no side is black;
/// back  from above behind: draws the upper outline against the background.
///
/// Space     the camera's (Light::is_in_camera_space), whatever the up axis of the scene.
/// Units     lux. A white diffuse surface that faces the key comes out just below 1.
std::vector<Light> default_lights();

/// The radiance of the constant environment that goes with them: what metals mirror.
inline constexpr float default_environment = 0.25f;

}  // namespace zoneplate
