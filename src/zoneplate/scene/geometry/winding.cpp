// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/winding.h"

#include <atomic>
#include <cstdint>
#include <utility>

#include "zoneplate/base/parallel.h"

namespace zoneplate {

namespace {
constexpr std::size_t block = 1 << 14;  // triangles
}  // namespace

int turn_of(const float3 (&corner)[3], const float3 (&normal)[3]) {
  const float3 facing = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const float along = dot(facing, normal[0] + normal[1] + normal[2]);
  return along < 0 ? 1 : along > 0 ? -1 : 0;
}

void reverse(Mesh& mesh) {
  parallel_ranges(mesh.index.size() / 3, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) std::swap(mesh.index[3 * t + 1], mesh.index[3 * t + 2]);
  });
}

void turn_to_normals(Mesh& mesh) {
  if (mesh.topology != Topology::Triangles || mesh.normal.size() != mesh.position.size()) return;
  const std::size_t triangles = mesh.index.size() / 3;
  std::atomic<std::int64_t> against = 0;  // how many more face away than not
  parallel_ranges(triangles, block, [&](std::size_t begin, std::size_t end) {
    std::int64_t sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const std::uint32_t* i = &mesh.index[3 * t];
      sum += turn_of({mesh.position[i[0]], mesh.position[i[1]], mesh.position[i[2]]},
                     {mesh.normal[i[0]], mesh.normal[i[1]], mesh.normal[i[2]]});
    }
    against += sum;
  });
  if (against > 0) reverse(mesh);
}

}  // namespace zoneplate
