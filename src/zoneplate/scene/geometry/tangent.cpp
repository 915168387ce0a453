// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/tangent.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cfloat>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "zoneplate/math/elementary.h"
#include "zoneplate/scene/first_of_equal.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// The bits of a number, equal for equal numbers: -0 + 0 is 0.
std::uint32_t word(float value) { return std::bit_cast<std::uint32_t>(value + 0.0f); }

std::uint64_t mix(std::uint64_t hash, float value) {
  hash = (hash ^ word(value)) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 29);
}
std::uint64_t mix(std::uint64_t hash, float3 v) { return mix(mix(mix(hash, v.x), v.y), v.z); }

/// The slot for a hash, whose low bits have the least entropy.
std::size_t slot(std::uint64_t hash) { return static_cast<std::size_t>(hash >> 20); }

/// For each vertex, the first one with equal position, normal and uv.
std::vector<std::uint32_t> weld(const Mesh& mesh, std::span<const float2> uv) {
  using Table = FirstOfEqual<8>;
  Table table(mesh.position.size());
  std::vector<std::uint32_t> first(mesh.position.size());
  const auto put = [&](std::uint32_t i) {
    const float3 p = mesh.position[i], n = mesh.normal[i];
    const float2 t = uv[i];
    return table.put(
        i, slot(mix(mix(mix(mix(1, p), n), t.x), t.y)),
        [&](std::uint32_t k) { return p == mesh.position[k] && n == mesh.normal[k] && t == uv[k]; },
        [&] {
          return Table::Key{word(p.x), word(p.y), word(p.z), word(n.x), word(n.y), word(n.z), word(t.x), word(t.y)};
        });
  };
  serial_ranges(first.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) first[i] = put(static_cast<std::uint32_t>(i));
  });
  return first;
}

/// A triangle of the welded mesh.
struct Face {
  std::array<std::uint32_t, 3> vertex{};                     ///< welded
  std::array<std::uint32_t, 3> neighbour{none, none, none};  ///< across the edge from corner i to i + 1
  std::array<std::uint32_t, 3> group{none, none, none};      ///< of each corner
  float3 tangent;                                            ///< the direction of increasing u, of unit length or zero
  bool is_degenerate = false;                                ///< two equal positions
  bool keeps_orientation = false;                            ///< counter-clockwise in uv as well
  bool joins_any = true;                                     ///< no area in uv: adopts its neighbours' orientation
};

bool is_zero(float x) { return !(std::abs(x) > FLT_MIN); }

float3 unit(float3 v) {
  const float n = length(v);
  return is_zero(n) ? v : v * (1 / n);
}

float3 across(float3 v, float3 normal) { return v - normal * dot(normal, v); }

/// Computes the derivative of position with respect to u by equations 18 and 19 of the source; of that with respect to
/// v only the length matters.
void measure(Face& face, std::span<const float3> position, std::span<const float2> uv) {
  const auto [a, b, c] = face.vertex;
  const float3 d1 = position[b] - position[a], d2 = position[c] - position[a];
  const float2 t1 = uv[b] - uv[a], t2 = uv[c] - uv[a];
  const float area = t1.x * t2.y - t1.y * t2.x;
  const float3 along_u = d1 * t2.y - d2 * t1.y, along_v = d2 * t1.x - d1 * t2.x;
  face.keeps_orientation = area > 0;
  if (is_zero(area)) return;
  const float size = std::abs(area), length_u = length(along_u), length_v = length(along_v);
  face.tangent = is_zero(length_u) ? along_u : along_u * ((area > 0 ? 1.0f : -1.0f) / length_u);
  face.joins_any = is_zero(length_u / size) || is_zero(length_v / size);
}

std::vector<Face> make_faces(const Mesh& mesh, std::span<const float2> uv) {
  const std::vector<std::uint32_t> first = weld(mesh, uv);
  std::vector<Face> faces(mesh.index.size() / 3);
  serial_ranges(faces.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      Face& face = faces[f];
      for (std::size_t c = 0; c < 3; ++c) face.vertex[c] = first[mesh.index[3 * f + c]];
      const float3 p = mesh.position[face.vertex[0]], q = mesh.position[face.vertex[1]],
                   r = mesh.position[face.vertex[2]];
      face.is_degenerate = p == q || q == r || r == p;
      if (!face.is_degenerate) measure(face, mesh.position, uv);
    }
  });
  return faces;
}

/// An edge of a face; `low` < `high` are its vertices.
struct FaceEdge {
  std::uint32_t low, high, face;
  std::uint8_t corner;  ///< the corner at which it begins
  bool is_rising;       ///< directed from low to high
};

std::vector<FaceEdge> list_face_edges(const std::vector<Face>& faces) {
  std::vector<FaceEdge> edges;
  edges.reserve(3 * faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    for (std::uint8_t c = 0; c < 3 && !faces[f].is_degenerate; ++c) {
      const std::uint32_t a = faces[f].vertex[c], b = faces[f].vertex[(c + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), f, c, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const FaceEdge& x, const FaceEdge& y) {
    return x.low != y.low ? x.low < y.low : x.high != y.high ? x.high < y.high : x.face < y.face;
  });
  return edges;
}

/// Connects each edge to the first later free edge with the same vertices and the opposite direction.
void join_neighbours(std::vector<Face>& faces) {
  const std::vector<FaceEdge> edges = list_face_edges(faces);
  std::array<std::size_t, 2> next{};  // for each direction, the position of the search, which never moves backwards
  const auto is_free = [&](const FaceEdge& e) { return faces[e.face].neighbour[e.corner] == none; };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const FaceEdge& edge = edges[i];
    if (!is_free(edge)) continue;
    std::size_t& k = next[edge.is_rising ? 1 : 0];
    k = std::max(k, i + 1);
    const auto is_same = [&](const FaceEdge& e) { return e.low == edge.low && e.high == edge.high; };
    while (k < edges.size() && is_same(edges[k]) && (edges[k].is_rising == edge.is_rising || !is_free(edges[k]))) ++k;
    if (k == edges.size() || !is_same(edges[k])) continue;
    faces[edge.face].neighbour[edge.corner] = edges[k].face;
    faces[edges[k].face].neighbour[edges[k].corner] = edge.face;
  }
}

/// Triangles around one vertex that have a common tangent there.
struct Group {
  std::uint32_t vertex;
  bool keeps_orientation;
  float3 sum{0, 0, 0};
};

/// Adds a face to the group and returns the index of its corner at the vertex; nothing if it belongs to another group.
std::uint32_t join_group(Face& face, const Group& group, std::uint32_t number) {
  std::uint32_t c = 0;
  while (c < 3 && face.vertex[c] != group.vertex) ++c;
  if (c == 3 || face.group[c] != none) return none;
  if (face.joins_any && face.group == std::array{none, none, none}) face.keeps_orientation = group.keeps_orientation;
  if (face.keeps_orientation != group.keeps_orientation) return none;
  face.group[c] = number;
  return c;
}

/// Collects a group from a corner across the edges at its vertex, in the standard's order: across its own edge first.
void gather_group(std::vector<Face>& faces, const Group& group, std::uint32_t number, std::uint32_t start,
                  std::vector<std::uint32_t>& pending) {
  pending.assign(1, start);
  while (!pending.empty()) {
    Face& face = faces[pending.back()];
    pending.pop_back();
    const std::uint32_t c = join_group(face, group, number);
    if (c == none) continue;
    const std::uint32_t left = face.neighbour[c], right = face.neighbour[(c + 2) % 3];
    if (right != none) pending.push_back(right);
    if (left != none) pending.push_back(left);
  }
}

std::vector<Group> make_groups(std::vector<Face>& faces) {
  std::vector<Group> groups;
  std::vector<std::uint32_t> pending;
  serial_ranges(faces.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      if (faces[f].is_degenerate || faces[f].joins_any) continue;
      for (std::uint32_t c = 0; c < 3; ++c) {
        if (faces[f].group[c] != none) continue;
        groups.push_back({faces[f].vertex[c], faces[f].keeps_orientation});
        gather_group(faces, groups.back(), static_cast<std::uint32_t>(groups.size() - 1), static_cast<std::uint32_t>(f),
                     pending);
      }
    }
  });
  return groups;
}

/// Sums the tangents of each group, weighted by the angle at the vertex, both in the plane of the normal.
void sum_tangents(const std::vector<Face>& faces, const Mesh& mesh, std::vector<Group>& groups) {
  for (const Face& face : faces)
    for (std::size_t c = 0; c < 3 && !face.joins_any && !face.is_degenerate; ++c) {
      if (face.group[c] == none) continue;
      const float3 normal = mesh.normal[face.vertex[c]], here = mesh.position[face.vertex[c]];
      const float3 before = unit(across(mesh.position[face.vertex[(c + 2) % 3]] - here, normal));
      const float3 after = unit(across(mesh.position[face.vertex[(c + 1) % 3]] - here, normal));
      groups[face.group[c]].sum += unit(across(face.tangent, normal)) * acos(dot(before, after));
    }
}

/// A unit vector perpendicular to the normal.
float3 some_tangent(float3 normal) {
  const float3 axis = std::abs(normal.x) < 0.5f ? float3{1, 0, 0} : float3{0, 1, 0};
  return normalize(across(axis, normal), {1, 0, 0});
}

float4 tangent_of(const Group& group, float3 normal) {
  float3 t = is_zero(length(group.sum)) ? some_tangent(normal) : unit(group.sum);
  if (!is_finite(t)) t = some_tangent(normal);  // edges whose square overflows
  return {t.x, t.y, t.z, group.keeps_orientation ? -1.0f : 1.0f};
}

/// The tangent of every corner of the mesh.
std::vector<float4> corner_tangents(const Mesh& mesh, std::span<const float2> uv) {
  std::vector<Face> faces = make_faces(mesh, uv);
  join_neighbours(faces);
  std::vector<Group> groups = make_groups(faces);
  sum_tangents(faces, mesh, groups);

  // A triangle without area joins the first group at each vertex, in the order of the triangles.
  std::vector<std::uint32_t> first_group(mesh.position.size(), none);
  for (const Face& face : faces)
    for (std::size_t c = 0; c < 3; ++c)
      if (first_group[face.vertex[c]] == none) first_group[face.vertex[c]] = face.group[c];

  std::vector<float4> tangent(mesh.index.size());
  for (std::size_t k = 0; k < tangent.size(); ++k) {
    const Face& face = faces[k / 3];
    const std::uint32_t vertex = face.vertex[k % 3];
    const std::uint32_t group = face.is_degenerate ? first_group[vertex] : face.group[k % 3];
    const float3 normal = mesh.normal[vertex];
    const float3 otherwise = some_tangent(normal);
    tangent[k] = group != none ? tangent_of(groups[group], normal) : float4{otherwise.x, otherwise.y, otherwise.z, 1};
  }
  return tangent;
}

template <class V>
void append_copy(std::vector<V>& values, std::size_t i) {
  if (!values.empty()) values.push_back(V(values[i]));
}

}  // namespace

void make_tangents(Mesh& mesh, int uv_set) {
  const std::vector<float2>& uv = uv_set == 0 ? mesh.uv0 : mesh.uv1;
  assert(mesh.topology == Topology::Triangles && mesh.normal.size() == mesh.position.size());
  assert(uv.size() == mesh.position.size());
  const std::vector<float4> corner = corner_tangents(mesh, uv);

  // A vertex keeps the first tangent of its corners; each other one is stored at a copy of the vertex.
  std::vector<float4> tangent(mesh.position.size(), float4{});
  std::vector<std::uint32_t> source(mesh.position.size(), none);  // the vertex of which this is a copy
  using Table = FirstOfEqual<5>;
  Table copies(mesh.index.size());
  for (std::size_t k = 0; k < corner.size(); ++k) {
    const std::uint32_t vertex = mesh.index[k];
    const float4 t = corner[k];
    if (source[vertex] == none) source[vertex] = vertex, tangent[vertex] = t;
    if (tangent[vertex] == t) continue;
    const auto copy = static_cast<std::uint32_t>(tangent.size());
    const std::uint32_t found = copies.put(
        copy, slot(mix(mix(mix(vertex + std::uint64_t{1}, xyz(t)), t.w), 0.0f)),
        [&](std::uint32_t c) { return source[c] == vertex && tangent[c] == t; },
        [&] {
          return Table::Key{vertex, word(t.x), word(t.y), word(t.z), word(t.w)};
        });
    if (found == copy) {
      tangent.push_back(t), source.push_back(vertex);
      append_copy(mesh.position, vertex), append_copy(mesh.normal, vertex);
      append_copy(mesh.uv0, vertex), append_copy(mesh.uv1, vertex), append_copy(mesh.color, vertex);
    }
    mesh.index[k] = found;
  }
  for (std::size_t i = 0; i < tangent.size(); ++i) {
    if (source[i] != none) continue;  // not used by any triangle
    const float3 any = some_tangent(mesh.normal[i]);
    tangent[i] = {any.x, any.y, any.z, 1};
  }
  mesh.tangent = std::move(tangent);
}

}  // namespace zoneplate
