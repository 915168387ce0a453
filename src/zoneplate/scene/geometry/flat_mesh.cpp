// SPDX-License-Identifier: Apache-2.0
#include <cassert>
#include <numeric>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/geometry/flat_normals.h"

namespace zoneplate {
namespace {

template <class V>
void unindex(std::vector<V>& values, const std::vector<std::uint32_t>& index) {
  if (values.empty()) return;
  std::vector<V> out(index.size());
  for (std::size_t k = 0; k < index.size(); ++k) out[k] = values[index[k]];
  values = std::move(out);
}

}  // namespace

void make_flat_normals(Mesh& mesh) {
  assert(mesh.topology == Topology::Triangles);
  mesh.normal.clear();
  unindex(mesh.position, mesh.index);
  unindex(mesh.tangent, mesh.index);
  unindex(mesh.uv0, mesh.index);
  unindex(mesh.uv1, mesh.index);
  unindex(mesh.color, mesh.index);
  std::iota(mesh.index.begin(), mesh.index.end(), 0u);
  mesh.normal.resize(mesh.position.size());
  constexpr std::size_t block = 4096;
  parallel_ranges(mesh.position.size() / 3, block, [&](std::size_t begin, std::size_t end) {
    const auto* const corners = reinterpret_cast<const std::uint8_t*>(&mesh.position[3 * begin]);
    FlatNormalKernels::of().make(corners, 3 * sizeof(float3), end - begin, &mesh.normal[3 * begin].x);
  });
}

}  // namespace zoneplate
