// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "zoneplate/scene/scene.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The lights and the environment of a scene.
struct Lighting {
  std::vector<Light> lights;  ///< in world space or camera space
  Environment environment;
  float3 ambient_light{0, 0, 0};  ///< Scene::ambient_light
};

/// Changes to the lighting of a scene.
struct LightingOptions {
  float intensity = 1;                     ///< multiplies every light
  std::optional<Environment> environment;  ///< in place of the scene's own
  /// Makes the studio of the default light (scene/default_lights.h), for callers that keep it; empty: it is made anew.
  std::function<std::shared_ptr<const PreparedEnvironment>()> studio;
};

/// The scene's own lighting, changed by the options.
///
/// A scene without lights gets the default ones and their environment (scene/default_lights.h), unless the options
/// give an environment; in a scene of (Blinn-)Phong materials alone the default lights are divided by π, which the
/// diffuse term of these models lacks. The environment's radiance is also the ambient light of (Blinn-)Phong materials
/// where the scene has none.
Lighting make_lighting(const Scene& scene, const LightingOptions& options = {});

/// Lights the scene by make_lighting without options: a scene that has lights keeps them, any other gets the default
/// ones. The renderer itself adds no lights.
void light_unlit(Scene& scene);

/// Gives a material another shading model, and the nearest parameters that the model has.
void convert_material(Material& material, ShadingModel model);

}  // namespace zoneplate
#pragma GCC visibility pop
