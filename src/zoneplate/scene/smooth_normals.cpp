#include "zoneplate/scene/smooth_normals.h"

#include <array>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

constexpr float cos_50 = 0.64278761f, cos_25 = 0.90630779f;
constexpr std::size_t most_compared = 256, block = 4096;

struct Sum {
  double x = 0, y = 0, z = 0;
  void add(const Sum& s) { x += s.x, y += s.y, z += s.z; }
};

float3 direction(const Sum& s, float3 otherwise) {
  const double length = std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
  if (!(length > 0) || !std::isfinite(length)) return otherwise;
  return {static_cast<float>(s.x / length), static_cast<float>(s.y / length), static_cast<float>(s.z / length)};
}

/// The corners about each vertex, in the order of the triangles.
struct Corners {
  std::vector<std::uint32_t> first, list;  ///< of vertex v: list[first[v] .. first[v + 1])
};

Corners corners_by_vertex(const Mesh& mesh) {
  Corners c;
  c.first.resize(mesh.position.size() + 2);
  make_large(c.list, mesh.index.size());
  // Counted one place ahead, so that after the filling each entry is where its vertex begins.
  for (const std::uint32_t v : mesh.index) ++c.first[v + 2];
  for (std::size_t v = 2; v < c.first.size(); ++v) c.first[v] += c.first[v - 1];
  for (std::uint32_t k = 0; k < mesh.index.size(); ++k) c.list[c.first[mesh.index[k] + 1]++] = k;
  return c;
}

/// A triangle's unit normal, and what it weighs at each of its corners.
struct Face {
  float3 normal;
  std::array<double, 3> weight;
};

Face measure(float3 a, float3 b, float3 c) {
  const double ux = double{b.x} - a.x, uy = double{b.y} - a.y, uz = double{b.z} - a.z;
  const double vx = double{c.x} - a.x, vy = double{c.y} - a.y, vz = double{c.z} - a.z;
  const double wx = double{c.x} - b.x, wy = double{c.y} - b.y, wz = double{c.z} - b.z;
  const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
  const double square = x * x + y * y + z * z;
  if (!(square > 0 && square < 1e300)) return {{0, 1, 0}, {}};
  const double area = std::sqrt(square), scale = 1 / area;
  const double u = ux * ux + uy * uy + uz * uz, v = vx * vx + vy * vy + vz * vz, w = wx * wx + wy * wy + wz * wz;
  return {{static_cast<float>(x * scale), static_cast<float>(y * scale), static_cast<float>(z * scale)},
          {area / (u * v), area / (u * w), area / (v * w)}};
}

Sum weighted(const std::vector<Face>& faces, std::uint32_t corner) {
  const Face& f = faces[corner / 3];
  const double w = f.weight[corner % 3];
  return {f.normal.x * w, f.normal.y * w, f.normal.z * w};
}

/// A corner whose normal is not that of its vertex.
struct Other {
  std::uint32_t corner;
  float3 normal;
};

/// Finds the normals about one vertex.
class Vertex {
 public:
  Vertex(Mesh& mesh, const std::vector<Face>& faces, std::vector<Other>& others)
      : mesh_(mesh), faces_(faces), others_(others) {}

  void smooth(std::uint32_t v, std::span<const std::uint32_t> corners) {
    if (corners.empty()) return;
    const float3 first = faces_[corners[0] / 3].normal;
    bool is_even = true;
    for (const std::uint32_t c : corners) is_even = is_even && dot(first, faces_[c / 3].normal) > cos_25;
    if (is_even || corners.size() > most_compared) {
      Sum sum;
      for (const std::uint32_t c : corners) sum.add(weighted(faces_, c));
      mesh_.normal[v] = direction(sum, first);
      return;
    }
    shares_.clear();
    for (const std::uint32_t c : corners) shares_.push_back(weighted(faces_, c));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const float3 own = faces_[corners[i] / 3].normal;
      Sum sum;
      for (std::size_t k = 0; k < corners.size(); ++k)
        if (k == i || dot(own, faces_[corners[k] / 3].normal) > cos_50) sum.add(shares_[k]);
      const float3 normal = direction(sum, own);
      if (i == 0) mesh_.normal[v] = normal;
      if (i != 0 && normal != mesh_.normal[v]) others_.push_back({corners[i], normal});
    }
  }

 private:
  Mesh& mesh_;
  const std::vector<Face>& faces_;
  std::vector<Other>& others_;
  std::vector<Sum> shares_;
};

template <class V>
void copy_last(std::vector<V>& values, std::uint32_t from) {
  if (!values.empty()) values.push_back(V(values[from]));
}

/// Gives the corners vertices of their own; neighbours in the list that agree share one.
void split(Mesh& mesh, const std::vector<std::vector<Other>>& blocks) {
  for (const std::vector<Other>& others : blocks) {
    std::size_t begin = 0;  // of those at the same vertex
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

void make_smooth_normals(Mesh& mesh) {
  assert(mesh.topology == Topology::Triangles && mesh.tangent.empty());
  std::vector<Face> faces;
  make_large(faces, mesh.index.size() / 3);
  parallel_ranges(faces.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      faces[f] = measure(mesh.position[mesh.index[3 * f]], mesh.position[mesh.index[3 * f + 1]],
                         mesh.position[mesh.index[3 * f + 2]]);
  });
  const Corners corners = corners_by_vertex(mesh);
  mesh.normal.assign(mesh.position.size(), {0, 1, 0});
  std::vector<std::vector<Other>> others((mesh.position.size() + block - 1) / block);
  parallel_ranges(mesh.position.size(), block, [&](std::size_t begin, std::size_t end) {
    Vertex vertex(mesh, faces, others[begin / block]);
    for (std::size_t v = begin; v < end; ++v)
      vertex.smooth(static_cast<std::uint32_t>(v),
                    std::span(corners.list).subspan(corners.first[v], corners.first[v + 1] - corners.first[v]));
  });
  split(mesh, others);
}

}  // namespace zoneplate
