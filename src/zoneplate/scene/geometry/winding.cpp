// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/winding.h"

#include <atomic>
#include <cstdint>
#include <utility>

#include "zoneplate/base/parallel.h"

namespace zoneplate {

void turn_to_normals(Mesh& mesh) {
  if (mesh.topology != Topology::Triangles || mesh.normal.size() != mesh.position.size()) return;
  constexpr std::size_t block = 1 << 14;  // triangles
  const std::size_t triangles = mesh.index.size() / 3;
  std::atomic<std::int64_t> against = 0;  // how many more face away than not
  parallel_ranges(triangles, block, [&](std::size_t begin, std::size_t end) {
    std::int64_t sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const std::uint32_t* i = &mesh.index[3 * t];
      const float3 a = mesh.position[i[0]];
      const float3 facing = cross(mesh.position[i[1]] - a, mesh.position[i[2]] - a);
      const float along = dot(facing, mesh.normal[i[0]] + mesh.normal[i[1]] + mesh.normal[i[2]]);
      sum += along < 0 ? 1 : along > 0 ? -1 : 0;
    }
    against += sum;
  });
  if (against <= 0) return;
  parallel_ranges(triangles, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) std::swap(mesh.index[3 * t + 1], mesh.index[3 * t + 2]);
  });
}

}  // namespace zoneplate
