#include "zoneplate/scene/obj_mesh.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <map>
#include <tuple>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"
#include "zoneplate/base/large_array.h"
#include "zoneplate/scene/triangulate.h"

namespace zoneplate {
namespace {

/// What makes a vertex one: the corner's indices, and its normal where that was made.
struct Key {
  ObjCorner corner;
  float3 made;
  bool operator==(const Key&) const = default;
};

/// Numbers keys in the order in which they come.
///
/// Keys hang in chains. Their places are first near each other when the indices are, as in most files, which is kind
/// to the cache; when a chain grows long for that, all are placed anew by a hash that scatters.
class VertexTable {
 public:
  std::uint32_t number(const Key& key) {
    int steps = 0;
    for (std::uint32_t i = heads_[place(key)]; i != none; i = next_[i], ++steps)
      if (keys_[i] == key) return i;
    const auto fresh = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(key);
    next_.push_back(none);
    const bool is_crowded = steps > 24 && !scattered_;
    if (is_crowded || keys_.size() > heads_.size()) {
      scattered_ = scattered_ || is_crowded;
      place_all(std::max(heads_.size(), std::bit_ceil(2 * keys_.size())));
    } else {
      hang(fresh);
    }
    return fresh;
  }

  const std::vector<Key>& keys() const { return keys_; }
  std::size_t bytes() const { return keys_.capacity() * (sizeof(Key) + sizeof(next_[0])) + heads_.size() * 4; }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;

  std::size_t place(const Key& key) const {
    const auto v = static_cast<std::uint32_t>(key.corner.position), t = static_cast<std::uint32_t>(key.corner.uv),
               n = static_cast<std::uint32_t>(key.corner.normal);
    const std::uint32_t h =
        scattered_ ? hash(v, t, n,
                          std::bit_cast<std::uint32_t>(key.made.x) ^ std::bit_cast<std::uint32_t>(key.made.y) * 5 ^
                              std::bit_cast<std::uint32_t>(key.made.z) * 9)
                   : v + 3 * t + 5 * n;
    return h & (heads_.size() - 1);
  }
  void hang(std::uint32_t i) {
    std::uint32_t& head = heads_[place(keys_[i])];
    next_[i] = std::exchange(head, i);
  }
  void place_all(std::size_t size) {
    heads_.assign(size, none);
    for (std::uint32_t i = 0; i < keys_.size(); ++i) hang(i);
  }

  std::vector<Key> keys_;
  std::vector<std::uint32_t> next_, heads_ = std::vector<std::uint32_t>(64, none);
  bool scattered_ = false;
};

/// The runs that make one mesh.
struct Plan {
  int object = 0, material = 0;
  ObjKind kind = ObjKind::Face;
  std::vector<ObjRun> runs;
};

std::vector<Plan> plan_meshes(const ObjFile& file, const ObjLayout& layout) {
  std::vector<Plan> plans;
  std::map<std::tuple<int, int, ObjKind>, std::size_t> numbers;
  for (const ObjRun& run : layout.runs) {
    std::array<bool, 3> seen{};
    for (std::uint32_t e = run.begin; e < run.end; ++e) {
      const ObjKind kind = file.chunks[run.chunk].elements[e].kind;
      if (std::exchange(seen[static_cast<std::size_t>(kind)], true)) continue;
      const auto [found, is_new] = numbers.try_emplace({run.object, run.material, kind}, plans.size());
      if (is_new) plans.push_back({run.object, run.material, kind, {}});
      plans[found->second].runs.push_back(run);
    }
  }
  return plans;
}

float linear(float code) { return decode_srgb(std::clamp(code, 0.0f, 1.0f)); }

/// Makes one mesh, element by element.
class Builder {
 public:
  Builder(const ObjFile& file, const std::vector<std::vector<float3>>& normals, const Plan& plan)
      : file_(file), normals_(normals), plan_(plan) {}

  std::uint64_t not_finite = 0, too_concave = 0;

  /// Adds the elements; gives up between some of them when `may_go_on(bytes so far)` says no.
  template <class Check>
  void add_all(const Check& may_go_on) {
    std::uint32_t since = 0;
    for (const ObjRun& run : plan_.runs)
      for (std::uint32_t e = run.begin; e < run.end; ++e) {
        const ObjChunk& chunk = file_.chunks[run.chunk];
        if (chunk.elements[e].kind != plan_.kind) continue;
        if (++since % 4096 == 0 && !may_go_on(bytes())) return;
        add(run.chunk, chunk, chunk.elements[e]);
      }
    may_go_on(bytes());
  }

  Mesh take() {
    const std::vector<Key>& keys = table_.keys();
    const bool has_uvs = std::any_of(keys.begin(), keys.end(), [](const Key& k) { return k.corner.uv >= 0; });
    const bool has_normals = plan_.kind == ObjKind::Face;
    Mesh mesh;
    mesh.topology = plan_.kind == ObjKind::Face   ? Topology::Triangles
                    : plan_.kind == ObjKind::Line ? Topology::Lines
                                                  : Topology::Points;
    mesh.material = plan_.material;
    mesh.index = std::move(index_);
    const bool has_colors = !file_.colors.empty();
    parallel_for(4, [&](std::size_t i) {
      if (i == 0) make_large(mesh.position, keys.size());
      if (i == 1 && has_normals) make_large(mesh.normal, keys.size());
      if (i == 2 && has_uvs) make_large(mesh.uv0, keys.size());
      if (i == 3 && has_colors) make_large(mesh.color, keys.size());
    });
    parallel_ranges(keys.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Key& key = keys[i];
        const auto p = static_cast<std::size_t>(key.corner.position);
        mesh.position[i] = file_.positions[p];
        if (has_normals)
          mesh.normal[i] =
              key.corner.normal >= 0 ? file_.normals[static_cast<std::size_t>(key.corner.normal)] : key.made;
        if (has_uvs) {
          const float2 uv = key.corner.uv >= 0 ? file_.uvs[static_cast<std::size_t>(key.corner.uv)] : float2{0, 1};
          mesh.uv0[i] = {uv.x, 1 - uv.y};
        }
        if (has_colors) mesh.color[i] = color_of(p);
      }
    });
    return mesh;
  }

 private:
  std::size_t bytes() const {
    return table_.bytes() + index_.capacity() * sizeof(index_[0]) + table_.keys().size() * 48;
  }

  float4 color_of(std::size_t position) const {
    const float4 c = file_.colors[position];
    return {linear(c.x), linear(c.y), linear(c.z), std::clamp(c.w, 0.0f, 1.0f)};
  }

  std::uint32_t vertex(std::uint32_t chunk, std::uint32_t corner) {
    Key key{file_.chunks[chunk].corners[corner], {}};
    if (plan_.kind != ObjKind::Face) {
      key.corner.normal = -1;
    } else if (!has_normal(file_, key.corner)) {
      key.corner.normal = -1;
      key.made = normals_[chunk][corner];
    }
    return table_.number(key);
  }

  void add(std::uint32_t c, const ObjChunk& chunk, const ObjElement& e) {
    polygon_.clear();
    for (std::uint32_t i = 0; i < e.count; ++i)
      polygon_.push_back(file_.positions[static_cast<std::size_t>(chunk.corners[e.first + i].position)]);
    if (!std::all_of(polygon_.begin(), polygon_.end(), is_finite)) {
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
  VertexTable table_;
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
  for (std::size_t i = 0; i < plans.size(); ++i) {
    out.not_finite += made[i].not_finite;
    out.too_concave += made[i].too_concave;
    if (!made[i].mesh.index.empty()) out.meshes.push_back({std::move(made[i].mesh), plans[i].object});
  }
  return out;
}

}  // namespace zoneplate
