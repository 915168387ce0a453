// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "zoneplate/shade/environment/cube.h"

namespace zoneplate {

class PreparedEnvironment;

/// The direction of the brightest soft box of the studio, of unit length, in the studio's space.
float3 studio_key();

/// The illuminance of the light from there that goes with the studio's environment, in lux.
inline constexpr float studio_key_lux = 1.7f;

/// The angle from the middle of that light to its edge, in radians: somewhat less than that of the soft box.
inline constexpr float studio_key_radius = 0.25f;

/// The radiance of a photographer's studio, neutral grey: a large soft box above on the left in front, a panel
/// overhead, a white card on the right, two strips behind that draw outlines, a reflector behind the viewer, and a
/// floor that glows. The boxes and the light are made for the Neutral curve, under which a white surface that faces
/// the light is just below white, and one that faces the viewer has its own colour.
///
/// Space     that of the camera: x right, y up, z towards the viewer.
CubeImage studio_cube(int side);

/// The studio, filtered for reflection.
PreparedEnvironment prepare_studio();
/// The same, made once for the process, by the first caller.
std::shared_ptr<const PreparedEnvironment> shared_studio();

/// A number for the studio's bytes (see content_hash): a change of the studio changes it.
std::uint64_t studio_key_number();

}  // namespace zoneplate
