// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/origin.h"

#include <algorithm>
#include <cmath>

namespace zoneplate {

void OriginChoice::add(double3 p) {
  constexpr double most = std::numeric_limits<float>::max();
  if (!(std::abs(p.x) <= most && std::abs(p.y) <= most && std::abs(p.z) <= most)) return;
  low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
  high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
}

void OriginChoice::add(std::span<const float3> positions) {
  constexpr std::size_t block = 256;
  for (std::size_t begin = 0; begin < positions.size() && !is_near(); begin += block)
    for (const float3 p : positions.subspan(begin, std::min(block, positions.size() - begin))) add(p);
}

double OriginChoice::reach() const {
  const auto greatest = [](double low, double high) { return std::max(-low, high); };
  return std::max({greatest(low_.x, high_.x), greatest(low_.y, high_.y), greatest(low_.z, high_.z)});
}

double OriginChoice::extent() const {
  const double longest = std::max({high_.x - low_.x, high_.y - low_.y, high_.z - low_.z});
  return longest > 0 ? longest : 1;
}

double3 OriginChoice::origin() const {
  if (is_empty() || is_near()) return {};
  int exponent = 0;
  std::frexp(extent(), &exponent);
  const double unit = std::ldexp(1.0, exponent - 4);
  const auto rounded = [&](double low, double high) { return std::floor((low + high) / 2 / unit + 0.5) * unit; };
  return {rounded(low_.x, high_.x), rounded(low_.y, high_.y), rounded(low_.z, high_.z)};
}

double3 center_far_mesh(Mesh& mesh) {
  OriginChoice choice;
  choice.add_used(mesh.index, [&](std::uint32_t vertex) { return mesh.position[vertex]; });
  const double3 centre = widened(narrowed(choice.origin()));
  if (centre == double3{}) return {};
  for (float3& p : mesh.position) p = relative_to(centre, widened(p));
  return centre;
}

void center_far_scene(Scene& scene) {
  std::vector<Affine> placed;
  placed.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) placed.push_back(widened(instance.world_from_object));
  center_far_scene(scene, placed);
}

void center_far_scene(Scene& scene, std::span<Affine> placed) {
  OriginChoice choice;
  for (std::size_t n = 0; n < placed.size(); ++n) {
    if (choice.is_near()) return;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[n].mesh)];
    choice.add_used(mesh.index,
                    [&](std::uint32_t vertex) { return transform_point(placed[n], widened(mesh.position[vertex])); });
  }
  scene.origin = choice.origin();
  if (scene.origin == double3{}) return;

  std::vector<double3> centres;
  for (Mesh& mesh : scene.meshes) centres.push_back(center_far_mesh(mesh));
  for (std::size_t n = 0; n < placed.size(); ++n) {
    Instance& instance = scene.instances[n];
    placed[n].move = transform_point(placed[n], centres[static_cast<std::size_t>(instance.mesh)]);
    instance.world_from_object = narrowed(placed[n], scene.origin);
  }
  for (Light& light : scene.lights)
    if (!light.is_in_camera_space) light.position = narrowed(widened(light.position) - scene.origin);
  for (Camera& camera : scene.cameras)
    camera.world_from_camera = narrowed(widened(camera.world_from_camera), scene.origin);
}

}  // namespace zoneplate
