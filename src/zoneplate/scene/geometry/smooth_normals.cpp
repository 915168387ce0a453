// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/smooth_normals.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/geometry/smooth_sums.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

constexpr std::size_t max_compared = 256, block = 4096;

/// Computes the normalized sum of the triangles at each vertex, in order, and marks vertices with possible creases.
void sum_all(Mesh& mesh, std::vector<char>& mark) {
  const SmoothSumKernels& kernels = SmoothSumKernels::of();
  const std::size_t vertices = mesh.position.size(), triangles = mesh.index.size() / 3;
  const auto* const position = reinterpret_cast<const float*>(mesh.position.data());
  auto* const normal = reinterpret_cast<float*>(mesh.normal.data());
  // Every thread reads all triangles for its own range of vertices, so that each vertex adds its triangles in order.
  const std::size_t share = vertices / static_cast<std::size_t>(thread_limit()) + 1;
  parallel_ranges(vertices, share, [&](std::size_t begin, std::size_t end) {
    const VertexRange own{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)};
    serial_ranges(triangles, [&](std::size_t first, std::size_t last) {
      kernels.add(position, vertices, &mesh.index[3 * first], last - first, own, normal);
    });
    kernels.normalize(normal + 3 * begin, end - begin, &mark[begin]);
  });
  parallel_ranges(triangles, block, [&](std::size_t begin, std::size_t end) {
    kernels.mark_turns(position, normal, vertices, &mesh.index[3 * begin], end - begin, mark.data());
  });
}

/// The corners at the marked vertices, in the order of the triangles.
struct Corners {
  std::vector<std::uint32_t> vertex;       ///< in ascending order
  std::vector<std::uint32_t> first, list;  ///< the corners of the i-th vertex are list[first[i] .. first[i + 1])
};

Corners corners_of(const Mesh& mesh, const std::vector<char>& is_selected) {
  if (std::find(is_selected.begin(), is_selected.end(), 1) == is_selected.end()) return {};
  constexpr std::size_t corners_per_range = 1 << 16;
  std::vector<std::vector<std::uint32_t>> found((mesh.index.size() + corners_per_range - 1) / corners_per_range);
  parallel_ranges(mesh.index.size(), corners_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (is_selected[mesh.index[k]] != 0) found[begin / corners_per_range].push_back(static_cast<std::uint32_t>(k));
  });
  Corners c;
  std::vector<std::uint32_t> place;  // index of a vertex in c.vertex
  for (std::uint32_t v = 0; v < is_selected.size(); ++v) {
    if (is_selected[v] == 0) continue;
    place.resize(is_selected.size());
    place[v] = static_cast<std::uint32_t>(c.vertex.size());
    c.vertex.push_back(v);
  }
  // Counts are stored one element ahead, so that after filling each entry is the first index of its vertex.
  c.first.resize(c.vertex.size() + 2);
  for (const std::vector<std::uint32_t>& part : found)
    for (const std::uint32_t k : part) ++c.first[place[mesh.index[k]] + 2];
  for (std::size_t i = 2; i < c.first.size(); ++i) c.first[i] += c.first[i - 1];
  c.list.resize(c.first.back());
  for (const std::vector<std::uint32_t>& part : found)
    for (const std::uint32_t k : part) c.list[c.first[place[mesh.index[k]] + 1]++] = k;
  return c;
}

struct Sum {
  double x = 0, y = 0, z = 0;
  void add(const Sum& s) { x += s.x, y += s.y, z += s.z; }
};

float3 direction(const Sum& s, float3 otherwise) {
  const double length = std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
  if (!(length > 0) || !std::isfinite(length)) return otherwise;
  return {static_cast<float>(s.x / length), static_cast<float>(s.y / length), static_cast<float>(s.z / length)};
}

/// A triangle's unit normal, and its weight at each corner.
struct Face {
  float3 normal;
  std::array<double, 3> weight;
};

/// Some triangles, whose normals and weights are computed in parallel lanes.
class Faces {
 public:
  static constexpr std::size_t most = 64;

  void set(std::size_t i, float3 a, float3 b, float3 c) {
    u_[0][i] = double{b.x} - a.x, u_[1][i] = double{b.y} - a.y, u_[2][i] = double{b.z} - a.z;
    v_[0][i] = double{c.x} - a.x, v_[1][i] = double{c.y} - a.y, v_[2][i] = double{c.z} - a.z;
    w_[0][i] = double{c.x} - b.x, w_[1][i] = double{c.y} - b.y, w_[2][i] = double{c.z} - b.z;
  }

  /// Computes the first `count`, rounded up to whole vectors of any width.
  void measure(std::size_t count) {
    constexpr std::size_t width = 8;
    for (std::size_t first = 0; first < count; first += width)
      for (std::size_t i = first; i < first + width; ++i) {
        const double x = u_[1][i] * v_[2][i] - u_[2][i] * v_[1][i], y = u_[2][i] * v_[0][i] - u_[0][i] * v_[2][i],
                     z = u_[0][i] * v_[1][i] - u_[1][i] * v_[0][i];
        const double square = x * x + y * y + z * z, area = std::sqrt(square), scale = 1 / area;
        const double u = u_[0][i] * u_[0][i] + u_[1][i] * u_[1][i] + u_[2][i] * u_[2][i];
        const double v = v_[0][i] * v_[0][i] + v_[1][i] * v_[1][i] + v_[2][i] * v_[2][i];
        const double w = w_[0][i] * w_[0][i] + w_[1][i] * w_[1][i] + w_[2][i] * w_[2][i];
        square_[i] = square;
        normal_[0][i] = x * scale, normal_[1][i] = y * scale, normal_[2][i] = z * scale;
        weight_[0][i] = area / (u * v), weight_[1][i] = area / (u * w), weight_[2][i] = area / (v * w);
      }
  }

  Face operator[](std::size_t i) const {
    if (!(square_[i] > 0 && square_[i] < 1e300)) return {{0, 1, 0}, {}};
    return {{static_cast<float>(normal_[0][i]), static_cast<float>(normal_[1][i]), static_cast<float>(normal_[2][i])},
            {weight_[0][i], weight_[1][i], weight_[2][i]}};
  }

 private:
  using Lane = std::array<double, most>;
  std::array<Lane, 3> u_{}, v_{}, w_{}, normal_{}, weight_{};  ///< edges ab, ac, bc; then the results
  Lane square_{};
};

Sum weighted(const Face& f, std::size_t corner) {
  const double w = f.weight[corner];
  return {f.normal.x * w, f.normal.y * w, f.normal.z * w};
}

/// A corner whose normal differs from that of its vertex.
struct Other {
  std::uint32_t corner;
  float3 normal;
};

/// Computes the normals at a vertex with creases.
class BentVertex {
 public:
  BentVertex(Mesh& mesh, float crease_cosine, std::vector<Other>& others)
      : mesh_(mesh), crease_cosine_(crease_cosine), others_(others) {}

  void smooth(std::uint32_t v, std::span<const std::uint32_t> corners) {
    own_.clear(), shares_.clear();
    for (std::size_t first = 0; first < corners.size(); first += Faces::most) {
      const std::span<const std::uint32_t> some = corners.subspan(first, std::min(Faces::most, corners.size() - first));
      for (std::size_t i = 0; i < some.size(); ++i) {
        const std::uint32_t* const t = &mesh_.index[some[i] / 3 * 3];
        faces_.set(i, mesh_.position[t[0]], mesh_.position[t[1]], mesh_.position[t[2]]);
      }
      faces_.measure(some.size());
      for (std::size_t i = 0; i < some.size(); ++i)
        own_.push_back(faces_[i].normal), shares_.push_back(weighted(faces_[i], some[i] % 3));
    }
    if (corners.size() > max_compared) {
      Sum sum;
      for (const Sum& share : shares_) sum.add(share);
      mesh_.normal[v] = direction(sum, own_[0]);
      return;
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Sum sum;
      for (std::size_t k = 0; k < corners.size(); ++k)
        if (k == i || dot(own_[i], own_[k]) > crease_cosine_) sum.add(shares_[k]);
      const float3 normal = direction(sum, own_[i]);
      if (i == 0) mesh_.normal[v] = normal;
      if (i != 0 && normal != mesh_.normal[v]) others_.push_back({corners[i], normal});
    }
  }

 private:
  Mesh& mesh_;
  float crease_cosine_;
  std::vector<Other>& others_;
  Faces faces_;
  std::vector<float3> own_;
  std::vector<Sum> shares_;
};

template <class V>
void copy_last(std::vector<V>& values, std::uint32_t from) {
  if (!values.empty()) values.push_back(V(values[from]));
}

/// Gives these corners their own vertices; corners of one vertex with equal normals share one.
void split(Mesh& mesh, const std::vector<std::vector<Other>>& blocks) {
  for (const std::vector<Other>& others : blocks) {
    std::size_t begin = 0;  // first corner at the same vertex
    std::vector<std::pair<float3, std::uint32_t>> made;
    std::vector<std::uint32_t> at;
    for (const Other& o : others) at.push_back(mesh.index[o.corner]);
    for (std::size_t i = 0; i < others.size(); ++i) {
      const std::uint32_t v = at[i];
      if (v != at[begin]) begin = i, made.clear();
      std::size_t k = 0;
      while (k < made.size() && made[k].first != others[i].normal) ++k;
      if (k == made.size()) {
        made.push_back({others[i].normal, static_cast<std::uint32_t>(mesh.position.size())});
        copy_last(mesh.position, v);
        copy_last(mesh.uv0, v);
        copy_last(mesh.uv1, v);
        copy_last(mesh.color, v);
        mesh.normal.push_back(others[i].normal);
      }
      mesh.index[others[i].corner] = made[k].second;
    }
  }
}

}  // namespace

void make_smooth_normals(Mesh& mesh, float crease_cosine) {
  assert(mesh.topology == Topology::Triangles && mesh.tangent.empty());
  mesh.normal.clear();
  reserve_large(mesh.normal, mesh.position.size());
  mesh.normal.resize(mesh.position.size());
  std::vector<char> is_bent(mesh.position.size());
  sum_all(mesh, is_bent);
  // The marks are for triangles within half of 50° of their vertex's normal.
  if (crease_cosine > smooth_crease_cosine) std::ranges::fill(is_bent, 1);

  const Corners corners = corners_of(mesh, is_bent);
  std::vector<std::vector<Other>> others((corners.vertex.size() + block - 1) / block);
  parallel_ranges(corners.vertex.size(), block, [&](std::size_t begin, std::size_t end) {
    BentVertex vertex(mesh, crease_cosine, others[begin / block]);
    for (std::size_t i = begin; i < end; ++i)
      vertex.smooth(corners.vertex[i],
                    std::span(corners.list).subspan(corners.first[i], corners.first[i + 1] - corners.first[i]));
  });
  split(mesh, others);
}

}  // namespace zoneplate
