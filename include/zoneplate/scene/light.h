// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "zoneplate/math/mat.h"
#include "zoneplate/math/vec.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The shape of a light's emission.
enum class LightKind {
  Directional,  ///< parallel light along `direction`, the same everywhere
  Point,        ///< light from `position`, equal in all directions
  Spot,         ///< light from `position` within a cone about `direction`
};

/// The attenuation of a point or spot light with the distance d.
enum class Falloff {
  InverseSquare,  ///< 1 / d², times glTF's window when `range` is finite (KHR_lights_punctual)
  Quadratic,      ///< 1 / (a0 + a1 d + a2 d²)
};

/// The part of the light that surfaces send to the viewer.
enum class LightComponent {
  All,           ///< the sum of the others
  Diffuse,       ///< reflected or transmitted by diffuse scattering, with the ambient term
  Specular,      ///< reflected by microfacets, sheen and the clear coat
  Transmission,  ///< passed through the surface without scattering (KHR_materials_transmission)
  Emission,      ///< emitted, and the colour of surfaces without lighting
};

/// A punctual light, in world space or fixed to the camera.
///
/// Units     `color` linear; `intensity` in lux (directional) or candela (point, spot), as KHR_lights_punctual;
///           angles from the axis in radians.
struct Light {
  std::string name{};                       ///< from the file, for listings; may be empty
  LightKind kind = LightKind::Directional;  ///< decides which of the following members count
  bool is_in_camera_space = false;          ///< `position` and `direction` are in the space of the rendering camera
  float3 color{1, 1, 1};                    ///< multiplies `intensity`
  float intensity = 1;                      ///< lux, or candela
  float3 position{0, 0, 0};                 ///< of point and spot lights
  float3 direction{0, 0, -1};               ///< from the light; of unit length in world space
  float range = std::numeric_limits<float>::infinity();  ///< where Falloff::InverseSquare ends; infinite: nowhere
  Falloff falloff = Falloff::InverseSquare;              ///< of point and spot lights
  float3 attenuation{1, 0, 0};                           ///< a0, a1, a2 of Falloff::Quadratic
  float inner_cone = 0;                                  ///< of spot lights: full intensity up to this angle
  float outer_cone = 0.7853982f;                         ///< of spot lights: no light beyond this angle
  float radius = 0;  ///< of the sphere (point, spot) or, in radians, of the disc in the sky: for soft shadows, and for
                     ///< highlights of metallic-roughness surfaces
};

/// The light in world space: a light in camera space is transformed by `world_from_camera`, others are unchanged.
Light in_world_space(Light light, const float4x4& world_from_camera);

}  // namespace zoneplate
#pragma GCC visibility pop
