// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/vertices.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

struct Triangle {
  std::uint32_t vertex[3];
};

/// The direction in which u grows over a triangle, and the sign of the triangle's area in (u, v).
float4 face_tangent(const Mesh& mesh, const Triangle& t, int uv_set) {
  const auto& uv = uv_set == 0 ? mesh.uv0 : mesh.uv1;
  if (uv.empty()) return {0, 0, 0, 1};
  const float3 p = mesh.position[t.vertex[0]];
  const float3 e1 = mesh.position[t.vertex[1]] - p, e2 = mesh.position[t.vertex[2]] - p;
  const float2 a = uv[t.vertex[1]] - uv[t.vertex[0]], b = uv[t.vertex[2]] - uv[t.vertex[0]];
  const float area = a.x * b.y - a.y * b.x;

  // v grows downwards in the image; the bitangent of a normal map points up, hence the sign.
  const float sign = area > 0 ? 1.0f : area < 0 ? -1.0f : 0.0f;
  const float3 along = (e1 * b.y - e2 * a.y) * sign;
  return {along.x, along.y, along.z, -sign};
}

std::vector<RecordLayout> make_layouts(const Scene& scene) {
  std::vector<RecordLayout> layouts(scene.materials.size());
  const auto reserve = [](int& offset, RecordLayout& layout) {
    if (offset < 0) offset = layout.floats, layout.floats += 4;
  };
  for (const Mesh& mesh : scene.meshes) {
    const auto m = static_cast<std::size_t>(mesh.material);
    const Material& material = scene.materials[m];
    for_texture_uses(material, [&](const TextureUse& use) {
      if (use.uv_set == 1) reserve(layouts[m].uv1, layouts[m]);
    });
    if (needs_tangents(material)) reserve(layouts[m].tangent, layouts[m]);
    if (!mesh.color.empty()) reserve(layouts[m].color, layouts[m]);
    if (!mesh.uv1.empty()) reserve(layouts[m].uv1, layouts[m]);
  }
  return layouts;
}

void write_record(const Mesh& mesh, const RecordLayout& layout, std::size_t v, float* to) {
  const float3 p = mesh.position[v];
  const float3 n = mesh.normal.empty() ? float3{} : mesh.normal[v];
  const float2 uv = mesh.uv0.empty() ? float2{} : mesh.uv0[v];
  to[0] = n.x, to[1] = n.y, to[2] = n.z, to[3] = p.x;
  to[4] = p.y, to[5] = p.z, to[6] = uv.x, to[7] = uv.y;
  const auto store = [&](int offset, float4 value) {
    float* const at = to + offset;
    if (offset >= 0) at[0] = value.x, at[1] = value.y, at[2] = value.z, at[3] = value.w;
  };
  store(layout.tangent, mesh.tangent.empty() ? float4{} : mesh.tangent[v]);
  store(layout.color, mesh.color.empty() ? float4{1, 1, 1, 1} : mesh.color[v]);
  const float2 uv1 = mesh.uv1.empty() ? float2{} : mesh.uv1[v];
  store(layout.uv1, {uv1.x, uv1.y, 0, 0});
}

}  // namespace

InterleavedVertices::InterleavedVertices(const Scene& scene)
    : layouts_(make_layouts(scene)), meshes_(scene.meshes.size()) {
  constexpr std::size_t vertices_per_range = 8192;
  std::vector<const float*> first(meshes_.size());
  for (std::size_t m = 0; m < meshes_.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    const RecordLayout& layout = layouts_[static_cast<std::size_t>(mesh.material)];
    const auto stride = static_cast<std::size_t>(layout.floats);
    auto* const records = reinterpret_cast<float*>(meshes_[m].reserve(mesh.position.size() * stride * sizeof(float)));
    first[m] = records;
    parallel_ranges(mesh.position.size(), vertices_per_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) write_record(mesh, layout, v, records + v * stride);
    });
  }
  for (const Instance& instance : scene.instances) instances_.push_back(first[static_cast<std::size_t>(instance.mesh)]);
}

void fetch_vertex_records(const InterleavedVertices& records, const FragmentBatch& batch, TriangleVertices& out) {
  const auto stride = static_cast<std::size_t>(records.layout(batch.material).floats);
  if (batch.one_instance) {
    // Records in one array are addressed where they are read.
    out.first = records.of_instance(batch.instance[0]), out.stride = stride;
    std::fill(std::begin(out.one_instance), std::end(out.one_instance), true);
    return;
  }
  out.first = nullptr;
  const auto find = [&](std::size_t i) {
    const float* const first = records.of_instance(batch.instance[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      out.record[k][i] = first + stride * batch.vertex[k][i];
      __builtin_prefetch(out.record[k][i]);
    }
  };
  std::fill(std::begin(out.one_instance), std::end(out.one_instance), true);
  for (int g = 0; g < batch.padded() / FragmentBatch::group; g = batch.next_run(g)) {
    const std::size_t first = static_cast<std::size_t>(g) * FragmentBatch::group;
    if (batch.is_flat_run[g]) {
      find(first);
      continue;
    }
    std::uint32_t difference = 0;
    for (std::size_t i = first; i < first + FragmentBatch::group; ++i) {
      find(i);
      difference |= batch.instance[i] ^ batch.instance[first];
    }
    out.one_instance[g] = difference == 0;
  }
}

namespace {

/// Array i of a member of ShadingState that is an array of arrays.
StateArray array(std::size_t member, std::size_t i = 0) {
  return {static_cast<std::int32_t>(member + i * sizeof(ShadingState::Array))};
}

}  // namespace

Interpolation interpolation(const RecordLayout& layout, const Attributes& attributes) {
  constexpr std::size_t position = offsetof(ShadingState, position), normal = offsetof(ShadingState, normal);
  constexpr std::size_t tangent = offsetof(ShadingState, tangent), color = offsetof(ShadingState, color);
  Interpolation out;
  const auto quad = [&](bool is_needed, int offset) -> Interpolation::Quad* {
    if (!is_needed || offset < 0) return nullptr;
    out.quad[out.quads].offset = offset;
    return &out.quad[out.quads++];
  };
  const auto store_coordinates = [&](Interpolation::Quad& q, std::size_t first, std::size_t set) {
    for (std::size_t c = 0; c < 2; ++c) {
      q.value[first + c] = array(offsetof(ShadingState, uv), 2 * set + c);
      q.dx[first + c] = array(offsetof(ShadingState, uv_dx), 2 * set + c);
      q.dy[first + c] = array(offsetof(ShadingState, uv_dy), 2 * set + c);
    }
  };
  const bool has_position = attributes.position || attributes.object_position;
  const auto store_position = [&](Interpolation::Quad& q, std::size_t at, std::size_t c) {
    q.value[at] = array(position, c);
    if (!attributes.object_position) return;
    q.dx[at] = array(offsetof(ShadingState, object_dx), c);
    q.dy[at] = array(offsetof(ShadingState, object_dy), c);
  };
  if (auto* q = quad(attributes.normal || has_position, 0)) {
    if (attributes.normal)
      for (std::size_t c = 0; c < 3; ++c) {
        q->value[c] = array(normal, c);
        if (!attributes.normal_change) continue;
        q->dx[c] = array(offsetof(ShadingState, normal_dx), c);
        q->dy[c] = array(offsetof(ShadingState, normal_dy), c);
      }
    if (has_position) store_position(*q, 3, 0);
  }
  if (auto* q = quad(has_position || attributes.uv[0], 4)) {
    if (has_position) store_position(*q, 0, 1), store_position(*q, 1, 2);
    if (attributes.uv[0]) store_coordinates(*q, 2, 0);
  }
  if (auto* q = quad(attributes.tangent, layout.tangent))
    for (std::size_t c = 0; c < 4; ++c) q->value[c] = array(tangent, c);
  if (auto* q = quad(attributes.color, layout.color))
    for (std::size_t c = 0; c < 4; ++c) q->value[c] = array(color, c);
  if (auto* q = quad(attributes.uv[1], layout.uv1)) store_coordinates(*q, 0, 1);
  return out;
}

void make_missing_tangents(const Scene& scene, const FragmentBatch& batch, int uv_set, ShadingState& p) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch.padded()); ++i) {
    const std::size_t leader = batch.leader(i);
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[batch.instance[leader]].mesh)];
    if (!mesh.tangent.empty()) continue;
    const float4 t =
        face_tangent(mesh, {{batch.vertex[0][leader], batch.vertex[1][leader], batch.vertex[2][leader]}}, uv_set);
    p.tangent[0][i] = t.x, p.tangent[1][i] = t.y, p.tangent[2][i] = t.z, p.tangent[3][i] = t.w;
  }
}

void compute_surface_gradients(const Scene& scene, const FragmentBatch& batch, int uv_set, SurfaceGradients& out) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch.padded()); ++i) {
    const std::size_t leader = batch.leader(i);
    const auto copy = [&](float(&to)[3][FragmentBatch::padded_capacity], float3 v) {
      to[0][i] = v.x, to[1][i] = v.y, to[2][i] = v.z;
    };
    if (leader != i) {  // the fragment before it is of the same triangle
      for (std::size_t c = 0; c < 3; ++c)
        out.u[c][i] = out.u[c][i - 1], out.v[c][i] = out.v[c][i - 1], out.normal[c][i] = out.normal[c][i - 1];
      continue;
    }
    const Instance& instance = scene.instances[batch.instance[leader]];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const auto& uv = uv_set == 0 ? mesh.uv0 : mesh.uv1;
    const std::uint32_t vertex[3] = {batch.vertex[0][leader], batch.vertex[1][leader], batch.vertex[2][leader]};
    const auto edge = [&](int k) {
      const float3 e = mesh.position[vertex[k]] - mesh.position[vertex[0]];
      const float4x4& m = instance.world_from_object;
      return xyz(m.column[0]) * e.x + xyz(m.column[1]) * e.y + xyz(m.column[2]) * e.z;
    };
    const float3 e1 = edge(1), e2 = edge(2), across = cross(e1, e2);
    const float square = dot(across, across);
    const bool is_flat = uv.empty() || !(square > 1e-30f);
    const float2 a = is_flat ? float2{} : uv[vertex[1]] - uv[vertex[0]];
    const float2 b = is_flat ? float2{} : uv[vertex[2]] - uv[vertex[0]];
    const float3 first = cross(e2, across) * (is_flat ? 0 : 1 / square);
    const float3 second = cross(across, e1) * (is_flat ? 0 : 1 / square);
    copy(out.u, first * a.x + second * b.x), copy(out.v, first * a.y + second * b.y);
    const bool is_mirrored = determinant3(instance.world_from_object) < 0;
    const float side = (batch.is_front[leader] > 0) != is_mirrored ? 1.0f : -1.0f;
    copy(out.normal, normalize(across, {0, 0, 0}) * side);
  }
}

void mark_lit(const Scene& scene, const FragmentBatch& batch, float* is_lit) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch.padded()); ++i) {
    const Instance& instance = scene.instances[batch.instance[batch.leader(i)]];
    is_lit[i] = scene.meshes[static_cast<std::size_t>(instance.mesh)].normal.empty() ? 0.0f : 1.0f;
  }
}

std::vector<InstanceTransform> make_instance_transforms(std::span<const Instance> instances) {
  std::vector<InstanceTransform> transforms;
  transforms.reserve(instances.size());
  for (const Instance& instance : instances) {
    InstanceTransform p{};
    const float4x4& world = instance.world_from_object;
    const float4x4 normal = normal_matrix(world);

    // Cofactors of tiny or huge transforms are scaled to about 1, so that their squares stay in range; cofactors that
    // are out of range themselves become 0.
    float greatest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float4 v = normal.column[c];
      greatest = std::max({greatest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    }
    const bool is_in_range = greatest > 1e-36f && greatest < 1e36f;
    const auto store = [](float4 v, float* to) { to[0] = v.x, to[1] = v.y, to[2] = v.z; };
    for (std::size_t c = 0; c < 4; ++c) store(world.column[c], p.world_from_object + 3 * c);
    for (std::size_t c = 0; c < 3; ++c)
      if (is_in_range) store(normal.column[c] * (1 / greatest), p.normal + 3 * c);
    p.handedness = determinant3(world) < 0 ? -1.0f : 1.0f;
    float least = std::numeric_limits<float>::max(), most = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float along = length(xyz(world.column[c]));
      p.scale += along / 3, least = std::min(least, along), most = std::max(most, along);
    }
    // The normal matrix is the transposed inverse times |determinant| / greatest.
    constexpr float rounding = 1e-5f;
    if (is_in_range && most - least > rounding * most) p.scale_along = std::abs(determinant3(world)) / greatest;
    p.keeps_normals = normal == float4x4{} ? 1.0f : 0.0f;
    transforms.push_back(p);
  }
  return transforms;
}

}  // namespace zoneplate
