// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/mesh.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <tuple>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/obj/vertex_table.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/geometry/triangulate.h"

namespace zoneplate {
namespace {

/// The runs of elements that become one mesh.
struct Plan {
  int object = 0, material = 0;
  ObjKind kind = ObjKind::Face;
  std::vector<ObjRun> runs;
};

std::vector<Plan> plan_meshes(const ObjFile& file, const ObjLayout& layout) {
  std::vector<Plan> plans;
  std::map<std::tuple<int, int, ObjKind>, std::size_t> numbers;
  std::size_t runs_done = 0;
  for (const ObjRun& run : layout.runs) {
    constexpr std::size_t runs_per_check = 1024;
    if (runs_done++ % runs_per_check == 0) check_deadline();
    std::array<bool, 3> seen{};
    // If all elements are triangles, the first one is representative.
    const ObjElements& elements = file.chunks[run.chunk].elements;
    const std::uint32_t end = elements.are_triangles() ? std::min(run.begin + 1, run.end) : run.end;
    for (std::uint32_t e = run.begin; e < end; ++e) {
      const ObjKind kind = elements[e].kind;
      if (std::exchange(seen[static_cast<std::size_t>(kind)], true)) continue;
      const auto [found, is_new] = numbers.try_emplace({run.object, run.material, kind}, plans.size());
      if (is_new) plans.push_back({run.object, run.material, kind, {}});
      plans[found->second].runs.push_back(run);
    }
  }
  return plans;
}

/// Triangulating an element of more corners than this may take long: the limits are checked before it.
constexpr std::uint32_t many_corners = 64;

float linear(float code) { return decode_srgb(std::clamp(code, 0.0f, 1.0f)); }

/// Builds one mesh, element by element.
class Builder {
 public:
  Builder(const ObjFile& file, const std::vector<std::vector<float3>>& normals, const Plan& plan)
      : file_(file), normals_(normals), plan_(plan), size_(size_of(file, plan)), table_(size_.vertices) {
    reserve_large(index_, size_.indices);
  }

  std::uint64_t not_finite = 0, too_concave = 0;

  /// Adds the elements; stops early if `may_go_on(bytes so far)` returns false.
  template <class Check>
  void add_all(const Check& may_go_on) {
    for (const ObjRun& run : plan_.runs) {
      const ObjChunk& chunk = file_.chunks[run.chunk];
      constexpr std::uint32_t block = 4096;
      for (std::uint32_t begin = run.begin; begin < run.end; begin += block) {
        if (!may_go_on(bytes())) return;
        const std::uint32_t end = std::min(run.end, begin + block);
        if (are_plain_triangles(chunk))
          add_triangles(chunk, begin, end);
        else
          for (std::uint32_t e = begin; e < end; ++e) {
            if (chunk.elements[e].kind != plan_.kind) continue;
            if (chunk.elements[e].count > many_corners && !may_go_on(bytes())) return;
            add(run.chunk, chunk, chunk.elements[e]);
          }
      }
    }
    may_go_on(bytes());
  }

  Mesh take() {
    const std::vector<ObjCorner>& corners = table_.corners();
    const bool has_uvs = std::any_of(corners.begin(), corners.end(), [](const ObjCorner& c) { return c.uv >= 0; });
    const auto position = [](const ObjCorner& c) { return static_cast<std::size_t>(c.position); };
    Mesh mesh;
    mesh.topology = plan_.kind == ObjKind::Face   ? Topology::Triangles
                    : plan_.kind == ObjKind::Line ? Topology::Lines
                                                  : Topology::Points;
    mesh.material = plan_.material;
    mesh.index = std::move(index_);
    const auto fill_kind = [&](std::size_t i) {
      if (i == 0)
        fill(mesh.position, [&](std::size_t v) { return file_.positions[position(corners[v])]; });
      else if (i == 1 && plan_.kind == ObjKind::Face)
        fill(mesh.normal, [&](std::size_t v) { return normal_of(v); });
      else if (i == 2 && has_uvs)
        fill(mesh.uv0, [&](std::size_t v) { return uv_of(corners[v].uv); });
      else if (i == 3 && !file_.colors.empty())
        fill(mesh.color, [&](std::size_t v) { return color_of(position(corners[v])); });
    };
    // For a small mesh, of which there may be very many, starting threads costs more than the work.
    constexpr std::size_t many_vertices = 4096;
    if (corners.size() >= many_vertices)
      parallel_for(4, fill_kind);
    else
      for (std::size_t i = 0; i < 4; ++i) fill_kind(i);
    return mesh;
  }

 private:
  /// The estimated number of vertices, and the maximum number of indices.
  struct Size {
    std::size_t vertices = 0, indices = 0;
  };
  static Size size_of(const ObjFile& file, const Plan& plan) {
    std::size_t corners = 0, indices = 0;
    for (const ObjRun& run : plan.runs) {
      const ObjElements& elements = file.chunks[run.chunk].elements;
      const std::size_t count = run.end - run.begin;
      if (elements.are_triangles()) corners += 3 * count, indices += 3 * count;
      for (std::uint32_t e = run.begin; e < run.end && !elements.are_triangles(); ++e) {
        const ObjElement element = elements[e];
        if (element.kind != plan.kind) continue;
        corners += element.count;
        indices += plan.kind == ObjKind::Face   ? 3 * (element.count - 2)
                   : plan.kind == ObjKind::Line ? 2 * (element.count - 1)
                                                : element.count;
      }
    }
    return {std::min(corners, std::max({file.positions.size(), file.uvs.size(), file.normals.size()})), indices};
  }

  std::size_t bytes() const {
    return table_.bytes() + index_.capacity() * sizeof(index_[0]) + table_.corners().size() * 48;
  }

  template <class V, class Value>
  void fill(std::vector<V>& values, const Value& value_of) const {
    const std::size_t count = table_.corners().size();
    reserve_large(values, count);
    for (std::size_t v = 0; v < count; ++v) values.push_back(value_of(v));
  }
  float3 normal_of(std::size_t v) const {
    const std::int32_t normal = table_.corners()[v].normal;
    return normal >= 0 ? file_.normals[static_cast<std::size_t>(normal)] : table_.made(v);
  }
  float2 uv_of(std::int32_t index) const {
    const float2 uv = index >= 0 ? file_.uvs[static_cast<std::size_t>(index)] : float2{0, 1};
    return {uv.x, 1 - uv.y};
  }
  float4 color_of(std::size_t position) const {
    const float4 c = file_.colors[position];
    return {linear(c.x), linear(c.y), linear(c.z), c.w < 1 ? std::max(c.w, 0.0f) : 1.0f};  // a NaN alpha is opaque
  }

  std::uint32_t vertex(std::uint32_t chunk, std::uint32_t corner) {
    ObjCorner found = file_.chunks[chunk].corners[corner];
    if (plan_.kind == ObjKind::Face && has_normal(file_, found)) return table_.number(found);
    found.normal = -1;
    return table_.number(found, plan_.kind == ObjKind::Face ? normals_[chunk][corner] : float3{});
  }

  /// Whether all elements are triangles and all their positions and normals are valid.
  bool are_plain_triangles(const ObjChunk& chunk) const {
    return plan_.kind == ObjKind::Face && chunk.elements.are_triangles() && chunk.corners.have_normals() &&
           !file_.has_odd_position && !file_.has_odd_normal;
  }
  void add_triangles(const ObjChunk& chunk, std::uint32_t begin, std::uint32_t end) {
    for (std::size_t i = std::size_t{3} * begin; i < std::size_t{3} * end; ++i)
      index_.push_back(table_.number(chunk.corners[i]));
  }

  void add(std::uint32_t c, const ObjChunk& chunk, const ObjElement& e) {
    polygon_.clear();
    for (std::uint32_t i = 0; i < e.count; ++i)
      polygon_.push_back(file_.positions[chunk.corners.position(e.first + i)]);
    if (file_.has_odd_position && !std::all_of(polygon_.begin(), polygon_.end(), is_finite)) {
      ++not_finite;
      return;
    }
    vertices_.clear();
    for (std::uint32_t i = 0; i < e.count; ++i) vertices_.push_back(vertex(c, e.first + i));
    if (plan_.kind == ObjKind::Point) {
      index_.insert(index_.end(), vertices_.begin(), vertices_.end());
    } else if (plan_.kind == ObjKind::Line) {
      for (std::size_t i = 0; i + 1 < vertices_.size(); ++i)
        index_.push_back(vertices_[i]), index_.push_back(vertices_[i + 1]);
    } else {
      triangles_.clear();
      if (!triangulate(polygon_, triangles_)) ++too_concave;
      for (const auto& t : triangles_)
        for (const std::uint32_t i : t) index_.push_back(vertices_[i]);
    }
  }

  const ObjFile& file_;
  const std::vector<std::vector<float3>>& normals_;
  const Plan& plan_;
  const Size size_;
  ObjVertexTable table_;
  std::vector<std::uint32_t> index_, vertices_;
  std::vector<float3> polygon_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace

ObjMeshes make_meshes(const ObjFile& file, const ObjLayout& layout, const std::vector<std::vector<float3>>& normals,
                      ImportBudget& budget) {
  struct Made {
    Mesh mesh;
    std::uint64_t not_finite = 0, too_concave = 0, bytes = 0;
  };
  const std::vector<Plan> plans = plan_meshes(file, layout);
  budget.take(plans.size() * (sizeof(Plan) + sizeof(ObjRun) + sizeof(Made) + sizeof(ObjMesh) + sizeof(Instance)));
  std::vector<Made> made(plans.size());
  std::atomic<std::uint64_t> all_bytes = 0;
  parallel_for(plans.size(), [&](std::size_t i) {
    Builder builder(file, normals, plans[i]);
    builder.add_all([&](std::uint64_t bytes) {
      const std::uint64_t added = bytes - std::exchange(made[i].bytes, bytes);
      return (all_bytes += added) <= budget.limits().memory && budget.has_time();
    });
    made[i].not_finite = builder.not_finite, made[i].too_concave = builder.too_concave;
    made[i].mesh = builder.take();
  });
  budget.check_time();
  budget.take(all_bytes);

  ObjMeshes out;
  out.meshes.reserve(plans.size());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    out.not_finite += made[i].not_finite;
    out.too_concave += made[i].too_concave;
    if (!made[i].mesh.index.empty()) out.meshes.push_back({std::move(made[i].mesh), plans[i].object});
  }
  return out;
}

}  // namespace zoneplate
