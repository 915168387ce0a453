// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/prepared_scene.h"

#include <cstddef>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/surface/material_plan.h"

namespace zoneplate {
namespace {

using EnvironmentMap = std::shared_ptr<const PreparedEnvironment>;

EnvironmentMap map_of(const Environment& environment, const std::vector<TextureImage>& images) {
  if (environment.image < 0 || environment.map) return environment.map;
  const TextureImage& image = images.at(static_cast<std::size_t>(environment.image));
  if (image.pixels.empty()) throw Error(ErrorKind::Input, "environment " + image.name + ": has no texels");
  return growing("environment",
                 [&] { return std::make_shared<const PreparedEnvironment>(prepare_equirectangular(image.pixels)); });
}

/// Completes an environment with an image by its map.
Lighting with_map(Lighting lighting, const EnvironmentMap& map) {
  Environment& environment = lighting.environment;
  if (environment.image < 0 || environment.map) return lighting;
  environment.map = map;
  return lighting;
}

Lighting lighting_of(const Scene& scene) { return {scene.lights, scene.environment, scene.ambient_light}; }

void free_images(Scene& scene) {
  for (TextureImage& image : scene.images) image.pixels = TexelImage();
}

}  // namespace

PreparedScene::PreparedScene(Scene scene, const MipOptions& mips) {
  lighting_ = with_map(lighting_of(scene), map_of(scene.environment, scene.images));
  textures_ = std::make_shared<const TextureSet>(TextureSet::take(scene, mips));
  vertices_ = std::make_shared<const InterleavedVertices>(scene);
  scene_ = std::make_shared<const Scene>(std::move(scene));
}

PreparedScene::PreparedScene(Scene scene, const PreparedScene& other) : textures_(other.textures_) {
  free_images(scene);
  vertices_ = std::make_shared<const InterleavedVertices>(scene);
  lighting_ = with_map(lighting_of(scene), other.lighting_.environment.map);
  scene_ = std::make_shared<const Scene>(std::move(scene));
}

PreparedScene PreparedScene::lit(Lighting lighting) const {
  PreparedScene copy = *this;
  copy.lighting_ = with_map(std::move(lighting), lighting_.environment.map);
  return copy;
}

}  // namespace zoneplate
