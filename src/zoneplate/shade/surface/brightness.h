#pragma once

#include <span>

#include "zoneplate/math/vec.h"

namespace zoneplate {

struct MaterialPlan;
struct PreparedLight;

/// No surface is brighter: shading clamps every channel to [0, brightest_color].
inline constexpr float brightest_color = 1e9f;

/// What no channel of any point of the materials is above, whatever its textures, its place and the viewer's.
///
/// Exact     a bound: emission, diffuse and specular reflection at their greatest, of all lights and the environment
///           together; brightest_color where vertex colours or textures of floats, which are not looked at, may make
///           anything of it.
float brightest_point(std::span<const MaterialPlan> plans, std::span<const PreparedLight> lights, float3 environment);

}  // namespace zoneplate
