// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// A scene with a mesh in the plane z = 0, unlit and double-sided, that faces an orthographic camera.
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

}  // namespace zoneplate
