#include "zoneplate/scene/smooth_normals.h"

#include <algorithm>
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

/// A triangle's unit normal, and what it weighs at each of its corners.
struct Face {
  float3 normal;
  std::array<double, 3> weight;
};

/// Some triangles, measured side by side.
class Faces {
 public:
  static constexpr std::size_t most = 64;

  void set(std::size_t i, float3 a, float3 b, float3 c) {
    u_[0][i] = double{b.x} - a.x, u_[1][i] = double{b.y} - a.y, u_[2][i] = double{b.z} - a.z;
    v_[0][i] = double{c.x} - a.x, v_[1][i] = double{c.y} - a.y, v_[2][i] = double{c.z} - a.z;
    w_[0][i] = double{c.x} - b.x, w_[1][i] = double{c.y} - b.y, w_[2][i] = double{c.z} - b.z;
  }

  /// Measures the first `count`, rounded up to whole vectors of any width.
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
  std::array<Lane, 3> u_{}, v_{}, w_{}, normal_{}, weight_{};  ///< edges ab, ac, bc; what is found
  Lane square_{};
};

Sum weighted(const Face& f, std::size_t corner) {
  const double w = f.weight[corner];
  return {f.normal.x * w, f.normal.y * w, f.normal.z * w};
}

/// What the triangles about each vertex come to, in their order. The first one's normal stands in Mesh::normal.
struct Sums {
  std::vector<Sum> sum;
  std::vector<std::uint16_t> count;  ///< of them, up to `most_compared` and one more
  std::vector<char> bends;           ///< whether one of them bends away from the first by more than 25°
};

/// Adds all triangles to those of their vertices that lie in [begin, end).
class Adder {
 public:
  Adder(Mesh& mesh, std::uint32_t begin, std::uint32_t end, Sums& sums)
      : mesh_(mesh), begin_(begin), size_(end - begin), sums_(sums) {}

  void add_all() {
    for (std::uint32_t t = 0; t < mesh_.index.size() / 3; ++t) {
      const std::uint32_t* const v = &mesh_.index[std::size_t{3} * t];
      if (!is_here(v[0]) && !is_here(v[1]) && !is_here(v[2])) continue;
      faces_.set(count_, mesh_.position[v[0]], mesh_.position[v[1]], mesh_.position[v[2]]);
      triangles_[count_++] = t;
      if (count_ == Faces::most) add();
    }
    add();
  }

 private:
  bool is_here(std::uint32_t v) const { return v - begin_ < size_; }

  void add() {
    faces_.measure(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const Face face = faces_[i];
      for (std::size_t k = 0; k < 3; ++k)
        if (const std::uint32_t v = mesh_.index[std::size_t{3} * triangles_[i] + k]; is_here(v)) add(v, face, k);
    }
    count_ = 0;
  }
  void add(std::uint32_t v, const Face& face, std::size_t corner) {
    std::uint16_t& count = sums_.count[v];
    if (count == 0) mesh_.normal[v] = face.normal;
    if (count <= most_compared) ++count;
    if (!(dot(mesh_.normal[v], face.normal) > cos_25)) sums_.bends[v] = 1;
    sums_.sum[v].add(weighted(face, corner));
  }

  Mesh& mesh_;
  std::uint32_t begin_, size_;
  Sums& sums_;
  Faces faces_;
  std::array<std::uint32_t, Faces::most> triangles_;
  std::size_t count_ = 0;
};

/// Corners about vertices that need a closer look, in the order of the triangles.
struct Corners {
  std::vector<std::uint32_t> vertex;       ///< in growing order
  std::vector<std::uint32_t> first, list;  ///< of the i-th: list[first[i] .. first[i + 1])
};

Corners corners_of(const Mesh& mesh, const std::vector<char>& is_wanted) {
  constexpr std::size_t corners_per_range = 1 << 16;
  std::vector<std::vector<std::uint32_t>> found((mesh.index.size() + corners_per_range - 1) / corners_per_range);
  parallel_ranges(mesh.index.size(), corners_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (is_wanted[mesh.index[k]] != 0) found[begin / corners_per_range].push_back(static_cast<std::uint32_t>(k));
  });
  Corners c;
  std::vector<std::uint32_t> place;  // of a vertex in c.vertex
  for (std::uint32_t v = 0; v < is_wanted.size(); ++v) {
    if (is_wanted[v] == 0) continue;
    place.resize(is_wanted.size());
    place[v] = static_cast<std::uint32_t>(c.vertex.size());
    c.vertex.push_back(v);
  }
  // Counted one place ahead, so that after the filling each entry is where its vertex begins.
  c.first.resize(c.vertex.size() + 2);
  for (const std::vector<std::uint32_t>& part : found)
    for (const std::uint32_t k : part) ++c.first[place[mesh.index[k]] + 2];
  for (std::size_t i = 2; i < c.first.size(); ++i) c.first[i] += c.first[i - 1];
  c.list.resize(c.first.back());
  for (const std::vector<std::uint32_t>& part : found)
    for (const std::uint32_t k : part) c.list[c.first[place[mesh.index[k]] + 1]++] = k;
  return c;
}

/// A corner whose normal is not that of its vertex.
struct Other {
  std::uint32_t corner;
  float3 normal;
};

/// Finds the normals about vertices where not all triangles are smooth with each other.
class BentVertex {
 public:
  BentVertex(Mesh& mesh, std::vector<Other>& others) : mesh_(mesh), others_(others) {}

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
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Sum sum;
      for (std::size_t k = 0; k < corners.size(); ++k)
        if (k == i || dot(own_[i], own_[k]) > cos_50) sum.add(shares_[k]);
      const float3 normal = direction(sum, own_[i]);
      if (i == 0) mesh_.normal[v] = normal;
      if (i != 0 && normal != mesh_.normal[v]) others_.push_back({corners[i], normal});
    }
  }

 private:
  Mesh& mesh_;
  std::vector<Other>& others_;
  Faces faces_;
  std::vector<float3> own_;
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

/// The normals of vertices about which all is smooth; the others remain marked in `bends`.
void smooth_even(Mesh& mesh, Sums& sums) {
  parallel_ranges(mesh.position.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (sums.count[v] == 0) continue;
      if (sums.count[v] > most_compared) sums.bends[v] = 0;
      if (sums.bends[v] == 0) mesh.normal[v] = direction(sums.sum[v], mesh.normal[v]);
    }
  });
}

}  // namespace

void make_smooth_normals(Mesh& mesh) {
  assert(mesh.topology == Topology::Triangles && mesh.tangent.empty());
  const std::size_t vertices = mesh.position.size();
  mesh.normal.assign(vertices, {0, 1, 0});
  Sums sums;
  make_large(sums.sum, vertices);
  sums.count.resize(vertices), sums.bends.resize(vertices);
  // Every thread goes through all triangles for vertices of its own: a vertex meets its triangles in their order.
  const std::size_t share = vertices / static_cast<std::size_t>(thread_limit()) + 1;
  parallel_ranges(vertices, share, [&](std::size_t begin, std::size_t end) {
    Adder(mesh, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), sums).add_all();
  });
  smooth_even(mesh, sums);

  const Corners corners = corners_of(mesh, sums.bends);
  std::vector<std::vector<Other>> others((corners.vertex.size() + block - 1) / block);
  parallel_ranges(corners.vertex.size(), block, [&](std::size_t begin, std::size_t end) {
    BentVertex vertex(mesh, others[begin / block]);
    for (std::size_t i = begin; i < end; ++i)
      vertex.smooth(corners.vertex[i],
                    std::span(corners.list).subspan(corners.first[i], corners.first[i + 1] - corners.first[i]));
  });
  split(mesh, others);
}

}  // namespace zoneplate
