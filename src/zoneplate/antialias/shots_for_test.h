#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate::antialias {

/// A scene seen by its own camera and resolved by a method, before tone mapping.
inline LinearImage shot(const Scene& scene, const std::string& method,
                        RenderOptions options = {.width = 160, .height = 120}, RenderCounts* counts = nullptr) {
  Renderer renderer(PreparedScene(scene), make_resolver(methods(), method));
  RenderedImage image = renderer.render(scene.cameras.at(0), {.options = options, .form = ImageForm::Linear});
  if (counts) *counts = image.counts;
  return std::move(image.linear);
}

/// The mean of the greens' distances.
inline double mean_error(const LinearImage& a, const LinearImage& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    sum += std::abs(double{a.values()[i].g} - double{b.values()[i].g});
  return sum / static_cast<double>(a.values().size());
}

/// A mesh in the plane z = 0, seen from both sides without light, that faces an orthographic camera.
inline Scene facing_scene(Mesh mesh, Material material = {}) {
  Scene scene;
  material.model = ShadingModel::Unlit;
  material.double_sided = true;
  scene.materials.push_back(std::move(material));
  mesh.normal.assign(mesh.position.size(), {0, 0, 1});
  scene.objects.push_back("mesh");
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({});
  Camera camera;
  camera.world_from_camera.column[3] = {0, 0, 5, 1};
  camera.is_orthographic = true;
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace zoneplate::antialias
