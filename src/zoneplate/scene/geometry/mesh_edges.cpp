// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace zoneplate {
namespace {

/// By vertex: the first one with the same position.
std::vector<std::uint32_t> welded(const std::vector<float3>& position) {
  std::vector<std::uint32_t> order(position.size()), out(position.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) { return std::tuple(position[v].x, position[v].y, position[v].z, v); };
  std::ranges::sort(order, {}, key);
  for (std::size_t i = 0; i < order.size(); ++i)
    out[order[i]] = i > 0 && position[order[i]] == position[order[i - 1]] ? out[order[i - 1]] : order[i];
  return out;
}

/// A side of a triangle.
struct Side {
  std::uint32_t low, high;  ///< welded vertices
  std::uint32_t face, corner;
  bool rises;  ///< leads from `low` to `high`
};

}  // namespace

std::vector<MeshEdge> mesh_edges(const Mesh& mesh) {
  const std::vector<std::uint32_t> vertex = welded(mesh.position);
  std::vector<Side> sides;
  sides.reserve(mesh.index.size());
  for (std::uint32_t face = 0; face < mesh.primitives(); ++face) {
    const std::uint32_t* const corners = &mesh.index[std::size_t{3} * face];
    const std::uint32_t v[3] = {vertex[corners[0]], vertex[corners[1]], vertex[corners[2]]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = v[k], to = v[(k + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), face, k, from < to});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.low, s.high, s.face); });

  std::vector<MeshEdge> out;
  out.reserve(sides.size() / 2);
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    const Side& side = sides[first];
    for (end = first + 1; end < sides.size() && sides[end].low == side.low && sides[end].high == side.high;) ++end;
    const std::uint32_t* const corners = &mesh.index[std::size_t{3} * side.face];
    MeshEdge edge{{corners[side.corner], corners[(side.corner + 1) % 3]}, {side.face, MeshEdge::no_face}};
    edge.is_manifold = end - first <= 2;
    if (end - first == 1) out.push_back(edge);
    for (std::size_t other = first + 1; other < end; ++other) {
      edge.face[1] = sides[other].face;
      edge.is_turned = sides[other].rises == side.rises;
      out.push_back(edge);
    }
  }
  return out;
}

}  // namespace zoneplate
