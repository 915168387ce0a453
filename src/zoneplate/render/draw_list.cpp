// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/draw_list.h"

#include <algorithm>
#include <iterator>

#include "zoneplate/base/deadline.h"

namespace zoneplate {
namespace {

constexpr std::uint32_t corners_of_quad[] = {0, 1, 2, 2, 1, 3};

/// The indices of `count` quads.
std::vector<std::uint32_t> quad_indices(std::size_t count) {
  std::vector<std::uint32_t> index;
  index.reserve(count * std::size(corners_of_quad));
  for (std::size_t i = 0; i < count; ++i)
    for (const std::uint32_t k : corners_of_quad) index.push_back(static_cast<std::uint32_t>(4 * i) + k);
  return index;
}

/// `vertices` stores the segment vertices of points, whose mesh lists each vertex once.
QuadMesh quads_of(const Mesh& mesh, const RenderOptions& options, std::vector<std::uint32_t>& vertices) {
  const bool has_points = mesh.topology == Topology::Points;
  if (has_points)
    for (const std::uint32_t v : mesh.index) vertices.insert(vertices.end(), 2, v);
  const float extent = has_points ? options.point_size : options.line_width;
  const float2 size{static_cast<float>(options.width), static_cast<float>(options.height)};
  return {.position = mesh.position,
          .segment_vertices =
              std::span<const std::uint32_t>(has_points ? vertices : mesh.index).first(2 * mesh.primitives()),
          .has_points = has_points,
          .half_extent = {extent / size.x, extent / size.y},
          .size = size};
}

/// Makes the data of lines and points to which draws refer.
void make_quads(const Scene& scene, const RenderOptions& options, SceneDraws& out) {
  std::size_t most = 0;
  for (const Mesh& mesh : scene.meshes)
    if (mesh.topology != Topology::Triangles) most = std::max(most, mesh.primitives());
  if (most == 0) return;
  out.quad_index = quad_indices(most);
  out.quads.resize(scene.meshes.size());
  out.point_vertices.resize(scene.meshes.size());
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    if (scene.meshes[m].topology != Topology::Triangles)
      out.quads[m] = quads_of(scene.meshes[m], options, out.point_vertices[m]);
}

}  // namespace

SceneDraws make_draws(const Scene& scene, const float4x4& clip_from_world, const RenderOptions& options) {
  SceneDraws out;
  make_quads(scene, options, out);
  out.draws.reserve(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (i % 1024 == 0) check_deadline();
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    Draw draw;
    draw.alpha_mode = material.alpha_mode;
    draw.material = mesh.material;
    draw.instance = static_cast<std::uint32_t>(i);
    draw.clip_from_object = clip_from_world * instance.world_from_object;
    if (mesh.topology == Topology::Triangles) {
      draw.position = mesh.position;
      draw.index = mesh.index;
      draw.culls_back_faces = options.cull_back_faces && !material.double_sided;
      draw.is_mirrored = determinant3(instance.world_from_object) < 0;
    } else {
      draw.quads = &out.quads[static_cast<std::size_t>(instance.mesh)];
      draw.index = std::span<const std::uint32_t>(out.quad_index).first(6 * mesh.primitives());
    }
    out.draws.push_back(draw);
  }
  return out;
}

}  // namespace zoneplate
