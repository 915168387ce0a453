#include "zoneplate/scene/scene.h"

#include "zoneplate/base/parallel.h"

namespace zoneplate {

Box Scene::bounds() const {
  Box all;
  for (const Instance& instance : instances) {
    const Mesh& mesh = meshes[static_cast<std::size_t>(instance.mesh)];
    constexpr std::size_t block = 65536;
    std::vector<Box> part((mesh.index.size() + block - 1) / block);
    parallel_ranges(mesh.index.size(), block, [&](std::size_t begin, std::size_t end) {
      Box mine;
      for (std::size_t i = begin; i < end; ++i)
        mine.add(transform_point(instance.world_from_object, mesh.position[mesh.index[i]]));
      part[begin / block] = mine;
    });
    for (const Box& box : part) all.add(box);
  }
  return all;
}

}  // namespace zoneplate
