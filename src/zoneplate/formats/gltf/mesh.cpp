// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/gltf/accessor.h"
#include "zoneplate/formats/gltf/draco_primitive.h"
#include "zoneplate/formats/gltf/topology.h"
#include "zoneplate/scene/geometry/flat_normals.h"
#include "zoneplate/scene/geometry/tangent.h"
#include "zoneplate/scene/material_layers.h"
#include "zoneplate/scene/sanitize.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

/// A primitive that is being read.
struct Primitive {
  GltfFile& file;
  JsonView json, attributes;
  ElementRange range;                        ///< the range of vertices that its indices span, or of each corner
  std::span<const std::uint32_t> triangles;  ///< those that are read; empty: all
  std::vector<std::uint32_t> corners;        ///< their vertices
};

/// Reads an attribute of the primitive, which must have as many elements as the positions.
template <class Read>
auto read_attribute(const Primitive& p, const char* key, Read read) -> decltype(read(p.file, p.json, key, p.range)) {
  if (!p.attributes.has(key)) return {};
  const JsonView owner = p.attributes.renamed(p.json.place());
  const std::uint64_t count = count_elements(p.file, owner, key), expected = count_elements(p.file, owner, "POSITION");
  if (count != expected)
    owner.fail(std::string(key) + " has " + std::to_string(count) + " elements, POSITION has " +
               std::to_string(expected));
  return read(p.file, owner, key, p.range);
}

/// The minimum and maximum of a list.
struct Span {
  std::uint32_t low = std::numeric_limits<std::uint32_t>::max(), high = 0;
  void add(const Span& other) { low = std::min(low, other.low), high = std::max(high, other.high); }
};

Span span_of(const std::vector<std::uint32_t>& values) {
  constexpr std::size_t block = 1 << 16;
  std::vector<Span> parts((values.size() + block - 1) / block);
  parallel_ranges(values.size(), block, [&](std::size_t begin, std::size_t end) {
    Span mine;
    for (std::size_t i = begin; i < end; ++i) mine.add({values[i], values[i]});
    parts[begin / block] = mine;
  });
  Span all;
  for (const Span& part : parts) all.add(part);
  return all;
}

[[noreturn]] void fail_index(const Primitive& p, std::size_t i, std::uint32_t index, std::uint64_t vertices) {
  p.json.fail("index " + std::to_string(i) + " is " + std::to_string(index) + ", but POSITION has " +
              std::to_string(vertices) + " elements");
}

/// The corners of some triangles as vertices 0, 1, 2, ... Stores the vertices of the file in `corners`.
std::vector<std::uint32_t> read_corners(Primitive& p, std::uint64_t vertices) {
  const std::size_t count = 3 * p.triangles.size();
  p.file.budget().take(2 * count * sizeof(std::uint32_t));
  std::vector<std::uint32_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = 3 * p.triangles[i / 3] + static_cast<std::uint32_t>(i % 3);
  p.corners = p.json.has("indices") ? read_indices(p.file, p.json, "indices", {.numbers = order}) : order;
  for (std::size_t i = 0; i < count; ++i)
    if (p.corners[i] >= vertices) fail_index(p, order[i], p.corners[i], vertices);
  p.range.numbers = p.corners;
  for (std::size_t i = 0; i < count; ++i) order[i] = static_cast<std::uint32_t>(i);
  return order;
}

/// Reads the indices of the primitive (0, 1, 2, ... if there are none) and stores the range of vertices that they span
/// in `range`.
std::vector<std::uint32_t> read_order(Primitive& p) {
  const std::uint64_t vertices = count_elements(p.file, p.attributes.renamed(p.json.place()), "POSITION");
  if (vertices >= std::numeric_limits<std::uint32_t>::max())
    p.json.fail("POSITION has " + std::to_string(vertices) + " elements, more than 32-bit indices can name");
  if (!p.triangles.empty()) return read_corners(p, vertices);
  std::vector<std::uint32_t> order;
  if (!p.json.has("indices")) {
    p.file.budget().take(vertices * sizeof(std::uint32_t));
    order.resize(static_cast<std::size_t>(vertices));
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    return order;
  }
  order = read_indices(p.file, p.json, "indices");
  if (order.empty()) return order;
  const Span span = span_of(order);
  if (span.high >= vertices)
    fail_index(p, static_cast<std::size_t>(std::find(order.begin(), order.end(), span.high) - order.begin()), span.high,
               vertices);
  p.range = {span.low, std::uint64_t{span.high} - span.low + 1};
  for (std::size_t i = 0; span.low != 0 && i < order.size(); ++i) order[i] -= span.low;
  return order;
}

template <class V, class D>
void add_scaled(std::vector<V>& values, const std::vector<D>& deltas, float weight) {
  for (std::size_t i = 0; i < std::min(values.size(), deltas.size()); ++i) values[i] = values[i] + deltas[i] * weight;
}

/// Adds the morph targets with non-zero weight. The delta of a tangent has no w.
void apply_targets(const Primitive& p, std::span<const float> weights, Mesh& mesh) {
  const std::size_t targets = p.json.count("targets");
  if (!weights.empty() && targets != 0 && weights.size() != targets)
    p.json.fail("has " + std::to_string(targets) + " morph targets, but " + std::to_string(weights.size()) +
                " weights are given");
  for (std::size_t t = 0; t < std::min(targets, weights.size()); ++t) {
    if (weights[t] == 0) continue;
    p.file.budget().check_time();
    const JsonView target = p.json.element("targets", t, "target");
    // A target must have as many elements as the primitive's positions.
    const auto read = [&](const char* key, auto reader) -> decltype(reader(p.file, target, key, p.range)) {
      decltype(reader(p.file, target, key, p.range)) deltas;
      if (!target.has(key)) return deltas;
      p.file.read_optional([&] {
        auto found = reader(p.file, target, key, p.range);
        p.file.budget().give_back(found.size() * sizeof(found[0]));
        if (found.size() != mesh.position.size())
          target.fail(std::string(key) + " has " + std::to_string(count_elements(p.file, target, key)) +
                      " elements, expected " + std::to_string(count_elements(p.file, p.attributes, "POSITION")));
        deltas = std::move(found);
      });
      return deltas;
    };
    add_scaled(mesh.position, read("POSITION", read_float3), weights[t]);
    add_scaled(mesh.normal, read("NORMAL", read_float3), weights[t]);
    std::vector<float4> turned;
    for (const float3 d : read("TANGENT", read_float3)) turned.push_back({d.x, d.y, d.z, 0});
    add_scaled(mesh.tangent, turned, weights[t]);
    add_scaled(mesh.uv0, read("TEXCOORD_0", read_float2), weights[t]);
    add_scaled(mesh.uv1, read("TEXCOORD_1", read_float2), weights[t]);
    add_scaled(mesh.color, read("COLOR_0", read_color_change), weights[t]);
  }
}

void add_weighted(float4x4& sum, const float4x4& m, float weight) {
  for (std::size_t c = 0; c < 4; ++c) sum.column[c] = sum.column[c] + m.column[c] * weight;
}

/// Transforms the vertices by their joints (linear blend skinning; weights are divided by their sum).
void apply_joints(const Primitive& p, std::span<const float4x4> joints, Mesh& mesh) {
  const std::array<std::vector<float4>, 2> joint = {read_attribute(p, "JOINTS_0", read_joints),
                                                    read_attribute(p, "JOINTS_1", read_joints)};
  const std::array<std::vector<float4>, 2> weight = {read_attribute(p, "WEIGHTS_0", read_float4),
                                                     read_attribute(p, "WEIGHTS_1", read_float4)};
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    constexpr std::size_t vertices_per_check = 4096;
    if (v % vertices_per_check == 0) check_deadline();
    float4x4 blend{};
    for (float4& c : blend.column) c = {};
    float sum = 0;
    for (std::size_t set = 0; set < 2; ++set) {
      if (joint[set].empty() || weight[set].empty()) continue;
      const float4 j = joint[set][v], w = weight[set][v];
      for (const auto& [number, share] : {std::pair(j.x, w.x), {j.y, w.y}, {j.z, w.z}, {j.w, w.w}}) {
        if (!(share > 0)) continue;
        if (!(number >= 0 && number < static_cast<float>(joints.size())))
          p.json.fail(fmt::format("vertex {} uses joint {} of {}", p.range.first + v, number, joints.size()));
        add_weighted(blend, joints[static_cast<std::size_t>(number)], share);
        sum += share;
      }
    }
    if (!(sum > 0)) continue;
    for (float4& c : blend.column) c = c * (1 / sum);
    mesh.position[v] = transform_point(blend, mesh.position[v]);
    if (!mesh.normal.empty()) mesh.normal[v] = transform_vector(normal_matrix(blend), mesh.normal[v]);
    if (!mesh.tangent.empty()) {
      const float3 t = transform_vector(blend, xyz(mesh.tangent[v]));
      mesh.tangent[v] = {t.x, t.y, t.z, mesh.tangent[v].w};
    }
  }
  for (const auto* list : {&joint[0], &joint[1], &weight[0], &weight[1]})
    p.file.budget().give_back(list->size() * sizeof(float4));
}

/// Normalizes all normals; one without direction is replaced by that of the triangles at its vertex.
void normalize_normals(Mesh& m) {
  std::atomic<bool> has_zero = false;
  parallel_ranges(m.normal.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    bool is_here = false;
    for (std::size_t i = begin; i < end; ++i) {
      m.normal[i] = gltf_direction(m.normal[i]);
      is_here = is_here || m.normal[i] == float3{};
    }
    if (is_here) has_zero = true;
  });
  if (!has_zero) return;
  std::vector<float3> sum(m.normal.size());
  serial_ranges(m.topology == Topology::Triangles ? m.primitives() : 0, [&](std::size_t begin, std::size_t end) {
    for (const std::uint32_t* i = &m.index[3 * begin]; i != m.index.data() + 3 * end; i += 3) {
      const float3 n = flat_normal(m.position[i[0]], m.position[i[1]], m.position[i[2]]);
      for (std::size_t j = 0; j < 3; ++j) sum[i[j]] += n;
    }
  });
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (m.normal[i] == float3{}) m.normal[i] = normalize(sum[i], {0, 1, 0});
}

void normalize_tangents(Mesh& m) {
  for (std::size_t i = 0; i < m.tangent.size(); ++i) {
    const float3 axis = std::abs(m.normal[i].x) < 0.5f ? float3{1, 0, 0} : float3{0, 1, 0};
    float3 t = gltf_direction(xyz(m.tangent[i]));
    if (t == float3{}) t = normalize(axis - m.normal[i] * dot(axis, m.normal[i]));
    m.tangent[i] = {t.x, t.y, t.z, m.tangent[i].w < 0 ? -1.0f : 1.0f};
  }
}

std::uint64_t vertex_size(const Mesh& m) {
  return sizeof(float3) + (m.normal.empty() ? 0 : sizeof(float3)) + (m.tangent.empty() ? 0 : sizeof(float4)) +
         (m.uv0.empty() ? 0 : sizeof(float2)) + (m.uv1.empty() ? 0 : sizeof(float2)) +
         (m.color.empty() ? 0 : sizeof(float4));
}

/// Generates the attributes that the specification requires where the file lacks them.
void complete(const Primitive& p, std::optional<int> tangent_uv_set, Mesh& m) {
  ImportBudget& budget = p.file.budget();
  if (m.topology != Topology::Triangles) m.tangent.clear();
  if (m.topology == Topology::Triangles && m.normal.empty()) {
    budget.take(m.index.size() * (vertex_size(m) + sizeof(float3)));
    budget.give_back(m.position.size() * vertex_size(m));
    m.tangent.clear();
    make_flat_normals(m);
  }
  normalize_normals(m);
  normalize_tangents(m);
  if (!tangent_uv_set || m.topology != Topology::Triangles || !m.tangent.empty()) return;
  if ((*tangent_uv_set == 0 ? m.uv0 : m.uv1).size() != m.position.size()) {
    p.file.warn(p.json.place() + ": needs tangents, but has no TEXCOORD_" + std::to_string(*tangent_uv_set));
    return;
  }
  // The working memory of make_tangents: faces, edges, tables and tangents, at most 60 bytes per corner.
  const std::uint64_t working = m.index.size() * 60 + m.position.size() * 24;
  budget.check_time();
  budget.take(working + m.index.size() * (vertex_size(m) + sizeof(float4)));
  const std::uint64_t most = m.index.size() * (vertex_size(m) + sizeof(float4));
  const std::uint64_t before = m.position.size() * vertex_size(m);
  make_tangents(m, *tangent_uv_set);
  budget.give_back(working + most + before - m.position.size() * vertex_size(m));
}

/// The index of the primitive's material in the chosen variant.
std::optional<std::size_t> find_material(const JsonView& json, const GltfPose& pose, std::size_t count) {
  const auto variants = json.extension("KHR_materials_variants");
  for (std::size_t i = 0; variants && pose.variant && i < variants->count("mappings"); ++i) {
    const JsonView mapping = variants->element("mappings", i, "mapping");
    for (const std::size_t v : mapping.indices("variants", std::numeric_limits<std::uint32_t>::max()))
      if (v == *pose.variant) return mapping.index("material", count);
  }
  return json.find_index("material", count);
}

Mesh read_primitive(Primitive p, const GltfPose& pose, std::span<const float> weights,
                    std::span<const Material> materials) {
  GltfFile& file = p.file;
  const JsonView& json = p.json;
  const std::uint64_t mode = json.whole("mode", 4, 255);
  if (mode > 6) json.fail("mode is " + std::to_string(mode) + ", expected 0 to 6");
  std::optional<std::size_t> material;
  file.read_optional([&] { material = find_material(json, pose, materials.size()); });
  decode_draco_primitive(file, json);
  Mesh m;
  m.material = static_cast<int>(material.value_or(materials.size()));
  m.topology = gltf_topology(static_cast<int>(mode));
  if (!p.attributes.has("POSITION")) {
    file.warn(json.place() + ": has no POSITION, draws nothing");
    return m;
  }
  std::optional<int> uv_set_of_tangents;
  if (material && needs_tangents(materials[*material])) uv_set_of_tangents = tangent_uv_set(materials[*material]);

  std::vector<std::uint32_t> order = read_order(p);
  const std::size_t count = order.size();
  file.budget().take(count * 3 * sizeof(std::uint32_t));
  m.index = list_primitives(std::move(order), static_cast<int>(mode));
  file.budget().give_back((count * 4 - m.index.size()) * sizeof(std::uint32_t));
  m.position = read_attribute(p, "POSITION", read_float3);
  const auto read = [&](auto& values, const char* key, auto reader) {
    file.read_optional([&] { values = read_attribute(p, key, reader); });
  };
  read(m.normal, "NORMAL", read_float3);
  if (uv_set_of_tangents) read(m.tangent, "TANGENT", read_float4);
  if (m.normal.empty()) m.tangent.clear();  // as the specification requires
  read(m.uv0, "TEXCOORD_0", read_float2);
  read(m.uv1, "TEXCOORD_1", read_float2);
  read(m.color, "COLOR_0", read_color);
  apply_targets(p, weights, m);
  // The specification requires it: exporters write 255 in floats, or bytes without the flag that normalizes them.
  for (float4& c : m.color)
    for (float* x : {&c.x, &c.y, &c.z, &c.w}) *x = std::clamp(*x, 0.0f, 1.0f);
  if (!pose.joints.empty()) apply_joints(p, pose.joints, m);
  const NotFinite lost = drop_not_finite(m);
  if (lost.dropped > 0)
    file.warn(json.place() + ": vertices that are not finite, " + std::to_string(lost.dropped) + " primitives dropped");
  if (lost.replaced > 0)
    file.warn(json.place() + ": attributes of " + std::to_string(lost.replaced) +
              " vertices are not finite and are replaced");
  complete(p, uv_set_of_tangents, m);
  return m;
}

Primitive open_primitive(GltfFile& file, const JsonView& json, std::span<const std::uint32_t> triangles) {
  return {file, json, json.object("attributes").renamed(json.place()), {}, triangles, {}};
}

}  // namespace

float3 gltf_direction(float3 v) {
  const float square = dot(v, v);
  return square > 1e-30f && square < 1e30f ? normalize(v) : float3{};
}

Mesh load_gltf_triangles(GltfFile& file, const JsonView& primitive, const GltfPose& pose,
                         std::span<const Material> materials, std::span<const std::uint32_t> triangles) {
  Mesh m;
  file.read_optional([&] { m = read_primitive(open_primitive(file, primitive, triangles), pose, {}, materials); });
  return m;
}

std::vector<GltfPrimitive> load_gltf_mesh(GltfFile& file, std::size_t number, const GltfPose& pose,
                                          std::span<const Material> materials) {
  const JsonView json = file.root().element("meshes", number, "mesh");
  const std::vector<float> weights = pose.weights.empty() ? json.numbers("weights", 0) : pose.weights;
  const std::string name = json.text("name", "mesh " + std::to_string(number));
  std::vector<GltfPrimitive> out;
  for (std::size_t i = 0; i < json.count("primitives"); ++i) {
    file.budget().check_time();
    Mesh m;
    file.read_optional([&] {
      m = read_primitive(open_primitive(file, json.element("primitives", i, "primitive"), {}), pose, weights,
                         materials);
    });
    if (m.index.empty()) continue;
    file.budget().take(3 * sizeof(Mesh) + name.size());  // growing lists have up to twice their size
    m.name = name;
    out.push_back({static_cast<int>(i), std::move(m)});
  }
  return out;
}

}  // namespace zoneplate
