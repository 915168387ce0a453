// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/scene/scene.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The lights and the environment of a scene.
struct Lighting {
  std::vector<Light> lights{};    ///< in world space or camera space
  Environment environment{};      ///< light from infinitely far away
  float3 ambient_light{0, 0, 0};  ///< Scene::ambient_light
  /// The curve that goes with the light, where the caller chooses none: Neutral for the studio, which it was made for.
  ToneMapping tone_mapping = ToneMapping::None;
};

/// Which lights of a scene are used.
enum class LightSource {
  Scene,    ///< those of the scene, with a fill light where it needs one; the default light where it has none
  Alone,    ///< those of the scene without a fill light; the default light where it has none
  Default,  ///< the default light, or the environment of the options, in place of those of the scene
  Both,     ///< those of the scene and the default light
};

/// Changes to the lighting of a scene.
struct LightingOptions {
  LightSource source = LightSource::Scene;   ///< which lights are used
  float intensity = 1;                       ///< multiplies every light, and the studio
  std::optional<Environment> environment{};  ///< in place of the scene's own
  /// Makes the studio of the default light (scene/default_lights.h), for callers that keep it; empty: it is made anew.
  std::function<std::shared_ptr<const PreparedEnvironment>()> studio{};
};

/// The scene's own lighting, changed by the options.
///
/// A scene without lights gets the default light, unless the options give an environment; LightingOptions::source
/// selects that light for other scenes too. Where a material is metallic-roughness, that is a studio made in code,
/// which turns with the camera: an environment of soft boxes and a directional light from the brightest of them, for
/// the Neutral curve (Lighting::tone_mapping). Other scenes get three directional lights and a dim constant environment
/// (scene/default_lights.h); in a scene of (Blinn-)Phong materials alone these lights are divided by π,
/// which the diffuse term of these models lacks. A scene with lights of its own and no environment gets none, unless it
/// needs a fill light (Scene::needs_fill_light): that is the environment of the default light, dimmed to 0.15. The mean
/// radiance of the environment is also the ambient light of (Blinn-)Phong materials where the scene has none.
Lighting make_lighting(const Scene& scene, const LightingOptions& options = {});

/// Lights the scene by make_lighting: without options, a scene that has lights keeps them, and gets a fill light if it
/// needs one; any other gets the default ones. The renderer itself adds no lights.
void light_unlit(Scene& scene, const LightingOptions& options = {});

/// Gives a material another shading model, and the nearest parameters that the model has.
void convert_material(Material& material, ShadingModel model);

}  // namespace zoneplate
#pragma GCC visibility pop
