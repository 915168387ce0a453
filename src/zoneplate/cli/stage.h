#pragma once

#include <vector>

#include "zoneplate/cli/look.h"
#include "zoneplate/scene/scene.h"

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
  float3 ambient_;
};

}  // namespace zoneplate::cli
