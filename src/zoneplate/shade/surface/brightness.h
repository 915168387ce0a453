// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/math/vec.h"

namespace zoneplate {

struct MaterialPlan;
struct PreparedLight;

/// The upper bound of radiance: shading clamps every channel to [0, brightest_color].
inline constexpr float brightest_color = 1e9f;

/// An upper bound of every channel of every fragment of the materials, for any texture content, position and viewer.
///
/// Exact     a bound, not the maximum: the greatest emission, diffuse and specular reflection of all lights and the
///           environment are added up. Vertex colours and float textures have unknown values: with them the bound is
///           brightest_color.
float brightest_fragment(std::span<const MaterialPlan> plans, std::span<const PreparedLight> lights,
                         float3 environment);

}  // namespace zoneplate
