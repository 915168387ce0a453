#include "zoneplate/scene/fit.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/angle.h"

namespace zoneplate {
namespace {

// The point that lies farthest in each direction.
struct Farthest {
  std::vector<float> reach;
  std::vector<float3> point;

  explicit Farthest(std::size_t directions)
      : reach(directions, -std::numeric_limits<float>::infinity()), point(directions) {}
  void add(std::size_t direction, float value, float3 p) {
    if (value > reach[direction]) reach[direction] = value, point[direction] = p;
  }
};

// Directions across the planes that bound the view at fractions of its slopes, and along the view axis.
std::vector<float3> view_directions(const Camera& camera, float picture_aspect, float margin) {
  const auto& axes = camera.world_from_camera.column;
  const float3 right = xyz(axes[0]), above = xyz(axes[1]), back = xyz(axes[2]);
  const SineCosine half_fov = sine_cosine(static_cast<double>(camera.vertical_fov) / 2);
  const float slope = static_cast<float>(half_fov.sine / half_fov.cosine) * (1 - 2 * margin);
  std::vector<float3> directions = {back, -back};
  for (const float share : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
    for (const float side : {-1.0f, 1.0f}) {
      directions.push_back(right * side + back * (share * slope * picture_aspect));
      directions.push_back(above * side + back * (share * slope));
    }
  return directions;
}

// The vertices that primitives use, each once (a mesh has some six indices a vertex), in the order of their first use,
// which decides between points that lie equally far.
std::vector<std::uint32_t> used_vertices(const Mesh& mesh) {
  std::vector<std::uint8_t> is_known(mesh.position.size());
  std::vector<std::uint32_t> used;
  used.reserve(mesh.position.size());
  for (const std::uint32_t v : mesh.index)
    if (!std::exchange(is_known[v], std::uint8_t{1})) used.push_back(v);
  return used;
}

// Blocks of vertices are searched apart and compared in their order, so that ties do not depend on threads.
void add_instance(const Mesh& mesh, std::span<const std::uint32_t> vertices, const float4x4& world_from_object,
                  std::span<const float3> directions, Farthest& all) {
  constexpr std::size_t block = 16384;
  std::vector<Farthest> found((vertices.size() + block - 1) / block, Farthest(directions.size()));
  parallel_ranges(vertices.size(), block, [&](std::size_t begin, std::size_t end) {
    Farthest& mine = found[begin / block];
    for (std::size_t i = begin; i < end; ++i) {
      const float3 p = transform_point(world_from_object, mesh.position[vertices[i]]);
      for (std::size_t d = 0; d < directions.size(); ++d) mine.add(d, dot(directions[d], p), p);
    }
  });
  for (const Farthest& part : found)
    for (std::size_t d = 0; d < directions.size(); ++d) all.add(d, part.reach[d], part.point[d]);
}

}  // namespace

Camera fit_camera(const Scene& scene, float picture_aspect, const AutoFit& fit) {
  const Camera rough = fit_camera(scene.bounds(), picture_aspect, fit);
  const std::vector<float3> directions = view_directions(rough, picture_aspect, fit.margin);
  Farthest all(directions.size());
  std::vector<std::vector<std::uint32_t>> vertices(scene.meshes.size());
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    std::vector<std::uint32_t>& used = vertices[static_cast<std::size_t>(instance.mesh)];
    if (used.empty()) used = used_vertices(mesh);
    add_instance(mesh, used, instance.world_from_object, directions, all);
  }
  if (!(all.reach[0] > -std::numeric_limits<float>::infinity())) return rough;
  return fit_camera(std::span<const float3>(all.point), picture_aspect, fit);
}

}  // namespace zoneplate
