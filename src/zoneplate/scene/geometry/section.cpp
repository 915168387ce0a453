// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "zoneplate/base/deadline.h"
#include "zoneplate/math/double3.h"
#include "zoneplate/scene/geometry/section_cap.h"

namespace zoneplate {
namespace {

float3 mix(float3 a, float3 b, double t) { return narrowed(mix(widened(a), widened(b), t)); }

/// A plane in world space, with a unit normal.
struct WorldPlane {
  double3 normal;
  double offset;
  WorldPlane(const SectionPlane& plane, const Scene& scene) {
    const double size = std::sqrt(dot(plane.normal, plane.normal));
    normal = plane.normal * (1 / size);
    offset = plane.offset / size - dot(normal, scene.origin);
  }
  /// Positive beyond the plane.
  double distance(float3 place) const { return dot(normal, widened(place)) - offset; }
};

/// Where an edge meets the plane: the part of the way from its lesser end, so that all triangles that have the edge
/// find the same place.
struct Crossing {
  std::uint32_t from, to;
  double part;
};
Crossing crossing(const std::vector<float3>& position, const std::vector<double>& distance, std::uint32_t a,
                  std::uint32_t b) {
  const auto key = [&](std::uint32_t v) { return std::tuple(position[v].x, position[v].y, position[v].z); };
  if (key(b) < key(a)) std::swap(a, b);
  return {a, b, distance[a] / (distance[a] - distance[b])};
}

/// The distances of a mesh's vertices from a plane.
std::vector<double> plane_distances(const Mesh& mesh, const float4x4& world_from_object, const WorldPlane& plane) {
  std::vector<double> out;
  out.reserve(mesh.position.size());
  for (const float3& p : mesh.position) out.push_back(plane.distance(transform_point(world_from_object, p)));
  return out;
}

/// Builds the part of a mesh on the near side of a plane.
class MeshCut {
 public:
  MeshCut(const Mesh& mesh, const std::vector<double>& distance)
      : mesh_(mesh), distance_(distance), copies_(mesh.position.size(), no_vertex) {
    out_.name = mesh.name, out_.topology = mesh.topology, out_.material = mesh.material;
  }

  Mesh cut() {
    const auto corners = static_cast<std::size_t>(mesh_.vertices_per_primitive());
    for (std::size_t i = 0; i < mesh_.primitives(); ++i) add(std::span(mesh_.index).subspan(i * corners, corners));
    return std::move(out_);
  }

 private:
  static constexpr std::uint32_t no_vertex = 0xffffffffu;

  bool is_kept(std::uint32_t v) const { return distance_[v] <= 0; }

  /// Clips a primitive: a polygon of its kept corners and the crossings between kept ones and others.
  void add(std::span<const std::uint32_t> primitive) {
    std::uint32_t polygon[4];
    std::size_t count = 0;
    const std::size_t sides = primitive.size() == 3 ? 3 : primitive.size() - 1;
    for (std::size_t k = 0; k < primitive.size(); ++k) {
      const std::uint32_t v = primitive[k], after = primitive[(k + 1) % primitive.size()];
      if (is_kept(v)) polygon[count++] = copied(v);
      if (k < sides && is_kept(v) != is_kept(after)) polygon[count++] = crossed(v, after);
    }
    if (count < primitive.size()) return;
    if (primitive.size() < 3) {
      out_.index.insert(out_.index.end(), polygon, polygon + count);
      return;
    }
    const auto is_same = [&](std::size_t a, std::size_t b) {
      return out_.position[polygon[a]] == out_.position[polygon[b]];
    };
    for (std::size_t k = 1; k + 1 < count; ++k)
      if (!is_same(0, k) && !is_same(k, k + 1) && !is_same(0, k + 1))
        out_.index.insert(out_.index.end(), {polygon[0], polygon[k], polygon[k + 1]});
  }

  std::uint32_t copied(std::uint32_t v) {
    if (copies_[v] == no_vertex) {
      copies_[v] = static_cast<std::uint32_t>(out_.position.size());
      append(v, v, 0);
    }
    return copies_[v];
  }
  std::uint32_t crossed(std::uint32_t a, std::uint32_t b) {
    const Crossing c = crossing(mesh_.position, distance_, a, b);
    const auto [found, is_new] =
        crossings_.try_emplace({c.from, c.to}, static_cast<std::uint32_t>(out_.position.size()));
    if (is_new) append(c.from, c.to, c.part);
    return found->second;
  }
  /// A vertex between two others, with all attributes.
  void append(std::uint32_t a, std::uint32_t b, double t) {
    const auto s = static_cast<float>(t);
    out_.position.push_back(mix(mesh_.position[a], mesh_.position[b], t));
    if (!mesh_.normal.empty())
      out_.normal.push_back(a == b ? mesh_.normal[a]
                                   : normalize(mix(mesh_.normal[a], mesh_.normal[b], t), mesh_.normal[a]));
    if (!mesh_.tangent.empty()) {
      const float4 &from = mesh_.tangent[a], &to = mesh_.tangent[b];
      const float3 along = a == b ? xyz(from) : normalize(mix(xyz(from), xyz(to), t), xyz(from));
      out_.tangent.push_back({along.x, along.y, along.z, from.w});
    }
    const auto blend = [&](const auto& from, auto& to) {
      if (!from.empty()) to.push_back(a == b ? from[a] : from[a] + (from[b] - from[a]) * s);
    };
    blend(mesh_.uv0, out_.uv0), blend(mesh_.uv1, out_.uv1), blend(mesh_.color, out_.color);
  }

  const Mesh& mesh_;
  const std::vector<double>& distance_;
  Mesh out_;
  std::vector<std::uint32_t> copies_;  ///< by vertex of the mesh
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> crossings_;
};

/// The outline of an object in a plane, and a material that is cut.
struct SectionOutline {
  std::vector<OutlineSegment> segments;
  int material = 0;
};

/// Adds where an instance's triangles meet a plane.
void add_outline(const Mesh& mesh, const Instance& instance, const std::vector<double>& distance, SectionOutline& out) {
  std::vector<float3> place;
  for (const float3& p : mesh.position) place.push_back(transform_point(instance.world_from_object, p));
  const bool is_mirrored = determinant3(instance.world_from_object) < 0;
  for (std::size_t i = 0; i < mesh.primitives(); ++i) {
    const std::uint32_t* const v = &mesh.index[3 * i];
    // The triangle's border crosses the plane once outwards and once inwards; the cap's runs the other way.
    float3 leaving, entering;
    bool is_cut = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = v[k], b = v[(k + 1) % 3];
      if ((distance[a] <= 0) == (distance[b] <= 0)) continue;
      const Crossing c = crossing(mesh.position, distance, a, b);
      (distance[a] <= 0 ? leaving : entering) = mix(place[c.from], place[c.to], c.part);
      is_cut = true;
    }
    if (!is_cut || leaving == entering) continue;
    out.segments.push_back(is_mirrored ? OutlineSegment{leaving, entering} : OutlineSegment{entering, leaving});
    out.material = mesh.material;
  }
}

Mesh cap_of(const std::vector<std::array<float3, 3>>& triangles, const WorldPlane& plane) {
  Mesh cap;
  cap.name = "section";
  for (const auto& triangle : triangles)
    for (const float3& corner : triangle) {
      cap.index.push_back(static_cast<std::uint32_t>(cap.position.size()));
      cap.position.push_back(corner);
      cap.normal.push_back(narrowed(plane.normal));
    }
  return cap;
}

Material cap_material(const Material& cut, std::optional<float4> color) {
  Material material;
  material.name = "section";
  material.model = cut.model;
  material.double_sided = true;
  material.base_color = color ? *color : cut.base_color;
  if (!color) material.base_color.w = 1;
  material.metallic = 0, material.roughness = 0.8f;
  return material;
}

/// What is left of an instance's mesh, and whether it is all of it.
struct MeshRest {
  Mesh mesh;
  bool is_whole = true;
};
MeshRest rest_of(const Mesh& mesh, const float4x4& world_from_object, std::span<const WorldPlane> planes,
                 const WorldPlane* except = nullptr) {
  MeshRest rest;
  for (const WorldPlane& plane : planes) {
    if (&plane == except) continue;
    const Mesh& before = rest.is_whole ? mesh : rest.mesh;
    const std::vector<double> distance = plane_distances(before, world_from_object, plane);
    if (std::ranges::all_of(distance, [](double d) { return d <= 0; })) continue;
    Mesh after = MeshCut(before, distance).cut();
    rest.mesh = std::move(after), rest.is_whole = false;
  }
  return rest;
}

}  // namespace

void cut_scene(Scene& scene, std::span<const SectionPlane> sections, std::optional<float4> cap_color) {
  if (sections.empty()) return;
  std::vector<WorldPlane> planes;
  for (const SectionPlane& section : sections) planes.emplace_back(section, scene);

  // Outlines of whole objects: a solid may consist of several meshes.
  std::vector<std::map<int, SectionOutline>> outlines(planes.size());
  std::vector<Instance> instances;
  std::vector<int> is_cut(scene.materials.size(), 0);
  for (const Instance& instance : scene.instances) {
    check_deadline();
    const auto number = static_cast<std::size_t>(instance.mesh);
    if (scene.meshes[number].topology == Topology::Triangles)
      for (std::size_t p = 0; p < planes.size(); ++p) {
        const std::vector<double> distance =
            plane_distances(scene.meshes[number], instance.world_from_object, planes[p]);
        if (std::ranges::any_of(distance, [](double d) { return d > 0; }))
          add_outline(scene.meshes[number], instance, distance, outlines[p][instance.object]);
      }
    MeshRest rest = rest_of(scene.meshes[number], instance.world_from_object, planes);
    if (rest.is_whole) {
      instances.push_back(instance);
    } else if (!rest.mesh.index.empty()) {
      is_cut[static_cast<std::size_t>(rest.mesh.material)] = 1;
      Instance& left = instances.emplace_back(instance);
      left.mesh = static_cast<int>(scene.meshes.size());
      scene.meshes.push_back(std::move(rest.mesh));
    }
  }
  for (std::size_t m = 0; m < is_cut.size(); ++m)
    if (is_cut[m] != 0) scene.materials[m].double_sided = true;

  constexpr int first_cap_part = 1 << 20;  // apart from the parts that objects have in files
  for (std::size_t p = 0; p < planes.size(); ++p)
    for (const auto& [object, outline] : outlines[p]) {
      check_deadline();
      Mesh cap = cap_of(fill_outlines(outline.segments, planes[p].normal), planes[p]);
      MeshRest rest = rest_of(cap, {}, planes, &planes[p]);
      if (!rest.is_whole) cap = std::move(rest.mesh);
      if (cap.index.empty()) continue;
      cap.material = static_cast<int>(scene.materials.size());
      scene.materials.push_back(cap_material(scene.materials[static_cast<std::size_t>(outline.material)], cap_color));
      instances.push_back({static_cast<int>(scene.meshes.size()), object, {}, first_cap_part + static_cast<int>(p)});
      scene.meshes.push_back(std::move(cap));
    }
  scene.instances = std::move(instances);
}

}  // namespace zoneplate
