// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The names of the patterns of --solid-texture, with their parameters, for the help.
std::string solid_texture_names();

/// The text of --solid-texture, such as marble:scale=6.
///
/// Errors    ErrorKind::Usage for an unknown pattern, parameter or value.
const std::string& check_solid_texture(const std::string& text);

/// Gives every material of the scene the solid texture in place of its base colour. The parameter `scale` counts cells,
/// veins or rings along the longest side of the largest mesh.
void set_solid_texture(const std::string& text, Scene& scene);

}  // namespace zoneplate
