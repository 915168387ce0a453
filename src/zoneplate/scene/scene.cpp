#include "zoneplate/scene/scene.h"

namespace zoneplate {

Box Scene::bounds() const {
  Box all;
  for (const Instance& instance : instances) {
    const Mesh& mesh = meshes[static_cast<std::size_t>(instance.mesh)];
    for (const std::uint32_t i : mesh.index) all.add(transform_point(instance.world_from_object, mesh.position[i]));
  }
  return all;
}

}  // namespace zoneplate
