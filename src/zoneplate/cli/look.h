#pragma once

#include <optional>

#include "zoneplate/scene/scene.h"

namespace zoneplate::cli {

/// What the options about materials and light say.
struct Look {
  std::optional<ShadingModel> shading_model;  ///< for every material
  float light_intensity = 1;                  ///< multiplies every light
  std::optional<float3> environment;          ///< linear radiance from all sides
};

/// Applies the options to the scene, and answers the radiance of the constant environment.
///
/// A scene without lights gets the default ones and their environment (scene/default_lights.h), unless the options
/// give an environment. The environment is also the ambient light of (Blinn-)Phong materials where the scene has none.
float3 apply_look(Scene& scene, const Camera& camera, const Look& look);

/// Gives a material another model, and the nearest parameters that model has.
void change_model(Material& material, ShadingModel model);

}  // namespace zoneplate::cli
