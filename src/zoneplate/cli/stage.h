#pragma once

#include <optional>
#include <vector>

#include "zoneplate/cli/look.h"
#include "zoneplate/scene/scene.h"
#include "zoneplate/shade/surface/material_plan.h"

namespace zoneplate::cli {

/// A loaded scene that is lit again for every camera, as the default lights follow it.
class Stage {
 public:
  explicit Stage(Scene scene)
      : scene_(std::move(scene)),
        lights_(scene_.lights),
        materials_(scene_.materials),
        ambient_(scene_.ambient_light) {}

  const Scene& scene() const { return scene_; }

  /// The textures of the scene as it was lit last. The first call makes them and frees the scene's images, so every
  /// later call must have the same `raw_colors`, and the scene must be lit with the same shading model.
  const TextureSet& take_textures(bool raw_colors) {
    if (!textures_) textures_.emplace(TextureSet::take(scene_, raw_colors));
    return *textures_;
  }

  /// What apply_look does to the scene as it was loaded.
  float3 light(const Camera& camera, const Look& look) {
    scene_.lights = lights_;
    scene_.materials = materials_;
    scene_.ambient_light = ambient_;
    return apply_look(scene_, camera, look);
  }

 private:
  Scene scene_;
  std::vector<Light> lights_;
  std::vector<Material> materials_;
  std::optional<TextureSet> textures_;
  float3 ambient_;
};

}  // namespace zoneplate::cli
