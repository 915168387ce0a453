// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/fit.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/angle.h"
#include "zoneplate/scene/used_vertices.h"

namespace zoneplate {
namespace {

constexpr std::size_t direction_count = 22, block_size = 1024;
using Directions = std::array<float3, direction_count>;
using Reach = std::array<float, direction_count>;

// The farthest point in each direction.
struct Farthest {
  Reach reach;
  std::array<float3, direction_count> point{};
};

// Directions across the planes that bound the view at fractions of its slopes, and along the view axis.
Directions view_directions(const Camera& camera, float picture_aspect, float margin) {
  const auto& axes = camera.world_from_camera.column;
  const float3 right = xyz(axes[0]), above = xyz(axes[1]), back = xyz(axes[2]);
  const SineCosine half_fov = sine_cosine(static_cast<double>(camera.vertical_fov) / 2);
  const float slope = static_cast<float>(half_fov.sine / half_fov.cosine) * (1 - 2 * margin);
  Directions directions = {back, -back};
  std::size_t at = 2;
  for (const float share : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
    for (const float side : {-1.0f, 1.0f}) {
      directions[at++] = right * side + back * (share * slope * picture_aspect);
      directions[at++] = above * side + back * (share * slope);
    }
  return directions;
}

// The vertices of one mesh in world space.
struct Placed {
  const Mesh& mesh;
  std::span<const std::uint8_t> is_used;
  const float4x4& world_from_object;

  std::size_t size() const { return mesh.position.size(); }
  float3 point(std::size_t v) const { return transform_point(world_from_object, mesh.position[v]); }
};

// The extent of the used vertices of a block in each direction.
Reach reach_of(const Placed& placed, std::size_t begin, std::size_t end, const Directions& directions) {
  constexpr std::size_t lanes = 24;  // whole vectors of any width up to eight
  std::array<float, lanes> x{}, y{}, z{}, reach;
  for (std::size_t d = 0; d < direction_count; ++d)
    x[d] = directions[d].x, y[d] = directions[d].y, z[d] = directions[d].z;
  reach.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t v = begin; v < end; ++v) {
    if (placed.is_used[v] == 0) continue;
    const float3 p = placed.point(v);
    for (std::size_t d = 0; d < lanes; ++d) {
      const float value = x[d] * p.x + y[d] * p.y + z[d] * p.z;
      reach[d] = value > reach[d] ? value : reach[d];
    }
  }
  Reach out;
  std::copy_n(reach.begin(), direction_count, out.begin());
  return out;
}

// Of the vertices with exactly this extent, the one that a primitive uses first. Usually they are at one position.
float3 first_used_at(const Placed& placed, float3 direction, float reach, const std::vector<std::size_t>& blocks) {
  std::optional<float3> found;
  bool is_one = true;
  for (const std::size_t b : blocks)
    for (std::size_t v = b * block_size; v < std::min((b + 1) * block_size, placed.size()); ++v) {
      const float3 p = placed.point(v);
      if (placed.is_used[v] == 0 || dot(direction, p) != reach) continue;
      is_one = is_one && found.value_or(p) == p;
      found = found.value_or(p);
    }
  for (std::size_t i = 0; !is_one; ++i)
    if (const float3 p = placed.point(placed.mesh.index[i]); dot(direction, p) == reach) return p;
  return found.value_or(float3{});
}

void add_instance(const Placed& placed, const Directions& directions, Farthest& all) {
  std::vector<Reach> found((placed.size() + block_size - 1) / block_size);
  parallel_ranges(placed.size(), block_size, [&](std::size_t begin, std::size_t end) {
    found[begin / block_size] = reach_of(placed, begin, end, directions);
  });
  for (std::size_t d = 0; d < direction_count; ++d) {
    float reach = -std::numeric_limits<float>::infinity();
    for (const Reach& r : found) reach = std::max(reach, r[d]);
    if (!(reach > all.reach[d])) continue;
    std::vector<std::size_t> blocks;
    for (std::size_t b = 0; b < found.size(); ++b)
      if (found[b][d] == reach) blocks.push_back(b);
    all.reach[d] = reach, all.point[d] = first_used_at(placed, directions[d], reach, blocks);
  }
}

}  // namespace

std::vector<float3> fit_directions(const Box& bounds, float picture_aspect, const AutoFit& fit) {
  const Directions directions = view_directions(fit_camera(bounds, picture_aspect, fit), picture_aspect, fit.margin);
  return {directions.begin(), directions.end()};
}

Camera fit_camera(const Scene& scene, float picture_aspect, const AutoFit& fit) {
  UsedVertices used(scene);
  const Camera rough = fit_camera(used.bounds(), picture_aspect, fit);
  const Directions directions = view_directions(rough, picture_aspect, fit.margin);
  Farthest all;
  all.reach.fill(-std::numeric_limits<float>::infinity());
  for (const std::size_t i : used.reaching(directions)) {
    const Instance& instance = scene.instances[i];
    add_instance(
        {scene.meshes[static_cast<std::size_t>(instance.mesh)], used.of(instance.mesh), instance.world_from_object},
        directions, all);
  }
  if (!(all.reach[0] > -std::numeric_limits<float>::infinity())) return rough;
  return fit_camera(std::span<const float3>(all.point), picture_aspect, fit);
}

bool faces(const Camera& camera, const float4x4& world_from_object, const std::array<float3, 3>& corner) {
  const auto& axis = world_from_object.column;
  // A mirrored triangle is turned.
  const float side = dot(cross(xyz(axis[0]), xyz(axis[1])), xyz(axis[2])) < 0 ? -1.0f : 1.0f;
  const float3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]) * side;
  const float3 towards_eye = camera.is_orthographic ? xyz(camera.world_from_camera.column[2])
                                                    : xyz(camera.world_from_camera.column[3]) - corner[0];
  return dot(normal, towards_eye) > 0;
}

bool sees_backs_alone(const Scene& scene, const Camera& camera) {
  bool is_any = false;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    if (mesh.index.empty()) continue;
    if (mesh.topology != Topology::Triangles) return false;
    if (scene.materials[static_cast<std::size_t>(mesh.material)].double_sided) return false;
    const float4x4& m = instance.world_from_object;
    const auto corner = [&](std::size_t i) { return transform_point(m, mesh.position[mesh.index[i]]); };
    for (std::size_t i = 0; i + 3 <= mesh.index.size(); i += 3)
      if (faces(camera, m, {corner(i), corner(i + 1), corner(i + 2)})) return false;
    is_any = true;
  }
  return is_any;
}

std::optional<AxisRange> range_along_view(const Scene& scene, const Camera& camera) {
  UsedVertices used(scene);
  const float3 back = xyz(camera.world_from_camera.column[2]), eye = xyz(camera.world_from_camera.column[3]);
  const std::array axes = {back, -back};
  constexpr float none = -std::numeric_limits<float>::infinity();
  std::array<float, 2> reach = {none, none};
  for (const std::size_t i : used.reaching(axes))
    for (std::size_t a = 0; a < axes.size(); ++a)
      reach[a] = std::max(reach[a], used.reach(scene.instances[i], axes[a]));
  if (reach[0] == none) return std::nullopt;
  const float own = dot(eye, back);
  return AxisRange{own - reach[0], own + reach[1]};
}

}  // namespace zoneplate
