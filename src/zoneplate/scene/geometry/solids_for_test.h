// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "zoneplate/math/box.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// A box of twelve triangles whose sides have vertices and normals of their own; turned inside out if `is_hollow`.
inline Mesh box_mesh(const Box& box, bool is_hollow = false) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const auto first = static_cast<std::uint32_t>(mesh.position.size());
      for (int corner = 0; corner < 4; ++corner) {
        const float at[3] = {static_cast<float>(side), static_cast<float>(corner & 1),
                             static_cast<float>(corner >> 1)};  // along axis, axis + 1 and axis + 2
        const auto along = [&](int a) { return at[(a - axis + 3) % 3]; };
        const float3 size = box.size();
        mesh.position.push_back(box.low + float3{size.x * along(0), size.y * along(1), size.z * along(2)});
        const float sign = (side == 1) == is_hollow ? -1.0f : 1.0f;
        mesh.normal.push_back({axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0});
      }
      const bool is_front = (side == 1) != is_hollow;
      for (const std::uint32_t k : {0u, 1u, 3u, 0u, 3u, 2u}) mesh.index.push_back(first + k);
      if (!is_front)
        for (std::size_t t = mesh.index.size() - 6; t < mesh.index.size(); t += 3)
          std::swap(mesh.index[t + 1], mesh.index[t + 2]);
    }
  return mesh;
}

/// A scene of one object with these meshes.
inline Scene scene_of(std::vector<Mesh> meshes) {
  Scene scene;
  scene.materials.emplace_back();
  scene.objects.push_back("solid");
  for (int i = 0; i < static_cast<int>(meshes.size()); ++i) scene.instances.push_back({i, 0, {}, i});
  scene.meshes = std::move(meshes);
  return scene;
}

/// The volume that the triangles of a scene enclose: the sum of signed tetrahedra about the origin.
inline double volume_of(const Scene& scene) {
  double sum = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const double sign = determinant3(instance.world_from_object) < 0 ? -1 : 1;
    for (std::size_t i = 0; i < mesh.index.size(); i += 3) {
      double3 p[3];
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = widened(transform_point(instance.world_from_object, mesh.position[mesh.index[i + k]]));
      sum += sign *
             (p[0].x * (p[1].y * p[2].z - p[1].z * p[2].y) + p[0].y * (p[1].z * p[2].x - p[1].x * p[2].z) +
              p[0].z * (p[1].x * p[2].y - p[1].y * p[2].x)) /
             6;
    }
  }
  return sum;
}

}  // namespace zoneplate
