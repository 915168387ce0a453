// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/displace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;  ///< the lower index first

Edge edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

void sort_unique(std::vector<Edge>& edges) {
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

/// The place of an edge in a sorted list, or its size.
std::size_t find_edge(const std::vector<Edge>& sorted, Edge edge) {
  const auto found = std::lower_bound(sorted.begin(), sorted.end(), edge);
  return found != sorted.end() && *found == edge ? static_cast<std::size_t>(found - sorted.begin()) : sorted.size();
}

float2 mean(float2 a, float2 b) { return (a + b) * 0.5f; }
float3 mean(float3 a, float3 b) { return (a + b) * 0.5f; }
float4 mean(float4 a, float4 b) { return (a + b) * 0.5f; }

/// The vertices of equal position have one number: that of the first of them.
std::vector<std::uint32_t> weld(const std::vector<float3>& position) {
  std::vector<std::uint32_t> order(position.size()), welded(position.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) { return std::tuple(position[v].x, position[v].y, position[v].z, v); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    welded[order[i]] = i > 0 && position[order[i]] == position[order[i - 1]] ? welded[order[i - 1]] : order[i];
  return welded;
}

/// A mesh between the passes of its refinement.
class Refiner {
 public:
  Refiner(const Mesh& mesh, const HeightMap& map, float tolerance)
      : map_(map), tolerance_(tolerance), mesh_(mesh), welded_(weld(mesh.position)) {
    mesh_.tangent.clear();
    append_heights();
  }

  /// Halves edges once. False if nothing was to be done, or if there would be more triangles than allowed.
  bool pass(std::size_t max_triangles, bool& is_complete);
  Mesh moved() &&;

 private:
  std::size_t triangles() const { return mesh_.index.size() / 3; }
  float texels_between(std::uint32_t a, std::uint32_t b) const {
    const float2 d = (mesh_.uv0[b] - mesh_.uv0[a]) * map_.texels;
    return std::sqrt(d.x * d.x + d.y * d.y);
  }
  void append_heights() {
    const std::size_t first = height_.size();
    height_.resize(mesh_.position.size());
    parallel_ranges(height_.size() - first, 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = first + begin; v < first + end; ++v) height_[v] = map_.height(mesh_.uv0[v]);
    });
  }
  bool deviates_along(std::uint32_t a, std::uint32_t b) const;
  bool deviates_within(const std::array<std::uint32_t, 3>& t) const;
  std::uint8_t marks_of(const std::array<std::uint32_t, 3>& t) const;
  Edge welded_edge(std::size_t triangle, std::size_t k) const {
    const std::uint32_t* const t = &mesh_.index[3 * triangle];
    return edge_of(welded_[t[k]], welded_[t[(k + 1) % 3]]);
  }
  std::size_t longest_edge(std::size_t triangle) const;
  std::vector<Edge> marked_edges() const;
  std::array<std::uint32_t, 3> triangle(std::size_t i) const {
    return {mesh_.index[3 * i], mesh_.index[3 * i + 1], mesh_.index[3 * i + 2]};
  }
  void add_midpoints(const std::vector<Edge>& edges, const std::vector<Edge>& marked);

  const HeightMap& map_;
  float tolerance_;
  Mesh mesh_;
  std::vector<std::uint32_t> welded_;
  std::vector<float> height_;
};

constexpr float unconditional = 16;  ///< texels that no edge exceeds

bool Refiner::deviates_along(std::uint32_t a, std::uint32_t b) const {
  const float2 from = mesh_.uv0[a], step = mesh_.uv0[b] - from;
  const int n = static_cast<int>(std::min(std::ceil(texels_between(a, b)) + 1, 2 * unconditional));
  for (int i = 1; i < n; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(n);
    if (std::abs(map_.height(from + step * t) - (height_[a] + (height_[b] - height_[a]) * t)) > tolerance_) return true;
  }
  return false;
}

/// Tests the texels inside the triangle.
bool Refiner::deviates_within(const std::array<std::uint32_t, 3>& t) const {
  const float longest = std::max({texels_between(t[0], t[1]), texels_between(t[1], t[2]), texels_between(t[2], t[0])});
  const int n = static_cast<int>(std::min(std::ceil(longest), unconditional)) + 1;
  for (int i = 1; i < n; ++i)
    for (int j = 1; j < n - i; ++j) {
      const float u = static_cast<float>(i) / static_cast<float>(n), v = static_cast<float>(j) / static_cast<float>(n);
      const float2 at =
          mesh_.uv0[t[0]] + (mesh_.uv0[t[1]] - mesh_.uv0[t[0]]) * u + (mesh_.uv0[t[2]] - mesh_.uv0[t[0]]) * v;
      const float flat = height_[t[0]] + (height_[t[1]] - height_[t[0]]) * u + (height_[t[2]] - height_[t[0]]) * v;
      if (std::abs(map_.height(at) - flat) > tolerance_) return true;
    }
  return false;
}

/// Bit k: the height map requires the edge from corner k to the next to be halved.
std::uint8_t Refiner::marks_of(const std::array<std::uint32_t, 3>& t) const {
  std::uint8_t marks = 0;
  int longest = 0;
  float texels[3];
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t a = t[static_cast<std::size_t>(k)], b = t[static_cast<std::size_t>((k + 1) % 3)];
    texels[k] = texels_between(a, b);
    if (texels[k] > texels[longest]) longest = k;
    // Below half a texel a bilinear height map has no more detail.
    if (texels[k] > unconditional || (texels[k] > 0.5f && deviates_along(a, b)))
      marks = static_cast<std::uint8_t>(marks | 1 << k);
  }
  if (marks == 0 && texels[longest] > 0.5f && deviates_within(t)) marks = static_cast<std::uint8_t>(1 << longest);
  return marks;
}

/// Appends the midpoints of `edges` (by vertex). `marked` are the edges by welded position.
void Refiner::add_midpoints(const std::vector<Edge>& edges, const std::vector<Edge>& marked) {
  const auto first = static_cast<std::uint32_t>(height_.size());
  const auto extend = [&](auto& attribute) {
    if (attribute.empty()) return;
    for (const auto& [a, b] : edges) attribute.push_back(mean(attribute[a], attribute[b]));
  };
  extend(mesh_.position), extend(mesh_.uv0), extend(mesh_.uv1), extend(mesh_.color);
  for (const auto& [a, b] : edges) {
    const float3 sum = mesh_.normal[a] + mesh_.normal[b];
    mesh_.normal.push_back(normalize(sum, mesh_.normal[a]));
    const std::size_t place = find_edge(marked, edge_of(welded_[a], welded_[b]));
    welded_.push_back(first + static_cast<std::uint32_t>(place));
  }
  append_heights();
}

/// The longest edge of a triangle in object space; of equal ones that of the greatest welded numbers, so that triangles
/// on both sides of a seam agree.
std::size_t Refiner::longest_edge(std::size_t triangle) const {
  const auto key = [&](std::size_t k) {
    const std::uint32_t* const t = &mesh_.index[3 * triangle];
    const float3 along = mesh_.position[t[k]] - mesh_.position[t[(k + 1) % 3]];
    return std::pair(dot(along, along), welded_edge(triangle, k));
  };
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (key(longest) < key(k)) longest = k;
  return longest;
}

/// The edges to be halved, by welded position, sorted. Of a triangle with such an edge the longest edge is one too, so
/// that angles stay bounded.
std::vector<Edge> Refiner::marked_edges() const {
  std::vector<std::uint8_t> marks(triangles());
  parallel_ranges(marks.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) marks[i] = marks_of(triangle(i));
  });
  std::vector<Edge> marked, more;
  for (std::size_t i = 0; i < marks.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (const Edge edge = welded_edge(i, k); (marks[i] >> k & 1) != 0 && edge.first != edge.second)
        more.push_back(edge);
  while (!more.empty()) {
    check_deadline();
    marked.insert(marked.end(), more.begin(), more.end());
    sort_unique(marked);
    more.clear();
    for (std::size_t i = 0; i < marks.size(); ++i) {
      bool is_marked[3];
      for (std::size_t k = 0; k < 3; ++k) is_marked[k] = find_edge(marked, welded_edge(i, k)) < marked.size();
      if (!is_marked[0] && !is_marked[1] && !is_marked[2]) continue;
      if (const std::size_t longest = longest_edge(i); !is_marked[longest]) more.push_back(welded_edge(i, longest));
    }
  }
  return marked;
}

bool Refiner::pass(std::size_t max_triangles, bool& is_complete) {
  check_deadline();
  const std::vector<Edge> marked = marked_edges();
  if (marked.empty()) return false;

  const auto is_marked = [&](std::size_t i, std::size_t k) {
    return find_edge(marked, welded_edge(i, k)) < marked.size();
  };
  std::vector<Edge> edges;  // by vertex
  std::size_t count = triangles();
  for (std::size_t i = 0; i < triangles(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (is_marked(i, k)) edges.push_back(edge_of(mesh_.index[3 * i + k], mesh_.index[3 * i + (k + 1) % 3])), ++count;
  if (count > max_triangles) return is_complete = false;
  sort_unique(edges);

  const auto first = static_cast<std::uint32_t>(mesh_.position.size());
  std::vector<std::uint32_t> index;
  index.reserve(3 * count);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t v : {a, b, c}) index.push_back(v);
  };
  for (std::size_t i = 0; i < triangles(); ++i) {
    // The longest edge runs from a to b; both halves of the triangle are halved again at their marked edge.
    const std::size_t longest = longest_edge(i);
    const auto corner = [&](std::size_t k) { return mesh_.index[3 * i + (k + longest) % 3]; };
    const std::uint32_t a = corner(0), b = corner(1), c = corner(2);
    const auto middle = [&](std::uint32_t from, std::uint32_t to) {
      return first + static_cast<std::uint32_t>(find_edge(edges, edge_of(from, to)));
    };
    if (!is_marked(i, longest)) {
      add(a, b, c);
      continue;
    }
    const std::uint32_t m = middle(a, b);
    if (is_marked(i, (longest + 1) % 3))
      add(m, b, middle(b, c)), add(m, middle(b, c), c);
    else
      add(m, b, c);
    if (is_marked(i, (longest + 2) % 3))
      add(a, m, middle(c, a)), add(middle(c, a), m, c);
    else
      add(a, m, c);
  }
  add_midpoints(edges, marked);
  mesh_.index = std::move(index);
  return true;
}

/// Calls use(first, last) for every group of vertices with one welded position, as places in `order`.
template <class Use>
void for_groups(const std::vector<std::uint32_t>& order, const std::vector<std::uint32_t>& welded, Use use) {
  for (std::size_t i = 0, end = 0; i < order.size(); i = end) {
    for (end = i + 1; end < order.size() && welded[order[end]] == welded[order[i]];) ++end;
    use(i, end);
  }
}

/// The normals of displaced triangles: of a vertex, and of those at its position whose old normals agree with its own.
void renew_normals(Mesh& mesh, const std::vector<std::uint32_t>& order, const std::vector<std::uint32_t>& welded) {
  std::vector<float3> sum(mesh.position.size());
  for (std::size_t i = 0; i < mesh.index.size(); i += 3) {
    const std::uint32_t *const t = &mesh.index[i], a = t[0], b = t[1], c = t[2];
    const float3 area = cross(mesh.position[b] - mesh.position[a], mesh.position[c] - mesh.position[a]);
    for (const std::uint32_t v : {a, b, c}) sum[v] = sum[v] + area;
  }
  const std::vector<float3> old = mesh.normal;
  for_groups(order, welded, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      float3 total{};
      for (std::size_t k = begin; k < end; ++k)
        if (dot(old[order[i]], old[order[k]]) > 0.99f) total = total + sum[order[k]];
      mesh.normal[order[i]] = normalize(total, old[order[i]]);
    }
  });
}

Mesh Refiner::moved() && {
  std::vector<std::uint32_t> order(mesh_.position.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(welded_[a], a) < std::pair(welded_[b], b); });
  for_groups(order, welded_, [&](std::size_t begin, std::size_t end) {
    float3 normal{};
    float height = 0;
    for (std::size_t i = begin; i < end; ++i) normal = normal + mesh_.normal[order[i]], height += height_[order[i]];
    const float3 way = normalize(normal, mesh_.normal[order[begin]]) * (height / static_cast<float>(end - begin));
    const float3 place = mesh_.position[order[begin]] + way;
    for (std::size_t i = begin; i < end; ++i) mesh_.position[order[i]] = place;
  });
  renew_normals(mesh_, order, welded_);
  return std::move(mesh_);
}

}  // namespace

Displaced displace(const Mesh& mesh, const HeightMap& map, const Refinement& refinement) {
  Refiner refiner(mesh, map, refinement.tolerance);
  Displaced out;
  while (refiner.pass(refinement.max_triangles, out.is_complete)) {
  }
  out.mesh = std::move(refiner).moved();
  return out;
}

}  // namespace zoneplate
