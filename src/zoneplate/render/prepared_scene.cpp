// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/prepared_scene.h"

#include <utility>

#include "zoneplate/shade/surface/material_plan.h"

namespace zoneplate {
namespace {

Lighting lighting_of(const Scene& scene) { return {scene.lights, scene.environment, scene.ambient_light}; }

void free_images(Scene& scene) {
  for (TextureImage& image : scene.images) image.pixels = TexelImage();
}

}  // namespace

PreparedScene::PreparedScene(Scene scene, const MipOptions& mips) {
  textures_ = std::make_shared<const TextureSet>(TextureSet::take(scene, mips));
  vertices_ = std::make_shared<const InterleavedVertices>(scene);
  lighting_ = lighting_of(scene);
  scene_ = std::make_shared<const Scene>(std::move(scene));
}

PreparedScene::PreparedScene(Scene scene, const PreparedScene& other) : textures_(other.textures_) {
  free_images(scene);
  vertices_ = std::make_shared<const InterleavedVertices>(scene);
  lighting_ = lighting_of(scene);
  scene_ = std::make_shared<const Scene>(std::move(scene));
}

PreparedScene PreparedScene::lit(Lighting lighting) const {
  PreparedScene copy = *this;
  copy.lighting_ = std::move(lighting);
  return copy;
}

}  // namespace zoneplate
