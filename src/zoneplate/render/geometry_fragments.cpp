// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/geometry_fragments.h"

namespace zoneplate {

GeometryFragmentShader::GeometryFragmentShader(const Scene& scene, const Camera& camera, const FragmentShader& surfaces)
    : scene_(scene), surfaces_(surfaces), to_viewer_(normalize(xyz(camera.world_from_camera.column[2]), {0, 0, 1})) {
  const float4x4 camera_from_world = inverse(camera.world_from_camera);
  for (const Instance& instance : scene.instances) {
    const float4x4 m = camera_from_world * instance.world_from_object;
    instances_.push_back(
        {normal_matrix(instance.world_from_object), {-m.column[0].z, -m.column[1].z, -m.column[2].z, -m.column[3].z}});
  }
}

GeometryFragmentShader::TriangleGeometry GeometryFragmentShader::geometry_of(const FragmentBatch& batch,
                                                                             std::size_t leader) const {
  const Mesh& mesh = scene_.meshes[static_cast<std::size_t>(scene_.instances[batch.instance[leader]].mesh)];
  const InstanceGeometry& placed = instances_[batch.instance[leader]];
  const float side = batch.is_front[leader] > 0 ? 1.0f : -1.0f;
  TriangleGeometry out;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t v = batch.vertex[k][leader];
    const float3 p = mesh.position[v];
    const float4& d = placed.distance;
    out.distance[k] = ((d.x * p.x + d.y * p.y) + d.z * p.z) + d.w;
    out.normal[k] = mesh.normal.empty()
                        ? to_viewer_
                        : normalize(transform_vector(placed.world_from_normal, mesh.normal[v]), to_viewer_) * side;
  }
  return out;
}

void GeometryFragmentShader::shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const {
  TriangleGeometry triangle;
  std::uint32_t known = 0;
  for (int i = 0; i < batch.count; ++i) {
    const std::size_t leader = batch.leader(static_cast<std::size_t>(i));
    if (i == 0 || batch.triangle[leader] != known) triangle = geometry_of(batch, leader);
    known = batch.triangle[leader];
    const float b = batch.b[0][i], c = batch.b[1][i];
    const auto mix = [&](const auto& at) { return at[0] + ((at[1] - at[0]) * b + (at[2] - at[0]) * c); };
    const float3 normal = normalize(mix(triangle.normal), to_viewer_);
    out.r[i] = normal.x, out.g[i] = normal.y, out.b[i] = normal.z;
    out.a[i] = mix(triangle.distance);
  }
}

}  // namespace zoneplate
