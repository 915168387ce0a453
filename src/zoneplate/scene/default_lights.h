// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/scene/light.h"

namespace zoneplate {

/// The lights of a scene that has none, and no metallic-roughness material (else: render/lighting.h): three directional
/// lights that follow the camera.
///
/// key   from above on the left, 40° off the view axis: the main light, which shows the shape;
/// fill  from the right, slightly below: less than a fifth of the key, so that no side is black;
/// back  from above behind: separates the upper outline from the background.
///
/// Space     the camera's (Light::is_in_camera_space), independently of the scene's up axis.
/// Units     lux. The result for a white diffuse surface that faces the key is just below 1.
std::vector<Light> default_lights();

/// The radiance of the accompanying constant environment, which metals reflect.
inline constexpr float default_environment = 0.25f;

}  // namespace zoneplate
