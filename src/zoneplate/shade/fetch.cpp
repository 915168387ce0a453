#include "zoneplate/shade/fetch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

/// 8 points, or the one that stands for 8 of one triangle, and where their corners' channels go.
struct Group {
  const Mesh* mesh[Batch::group];
  Triangle corner[Batch::group];
  int points = 0;
  float* out = nullptr;  ///< the next channel: [corner][point]

  void put(int point, int k, int channel, float value) { out[(3 * channel + k) * points + point] = value; }
  void put(int point, int k, float2 v) { put(point, k, 0, v.x), put(point, k, 1, v.y); }
  void put(int point, int k, float3 v) { put(point, k, 0, v.x), put(point, k, 1, v.y), put(point, k, 2, v.z); }
  void put(int point, int k, float4 v) { put(point, k, xyz(v)), put(point, k, 3, v.w); }
};

/// Reads one attribute of all corners, `otherwise` where a mesh lacks it.
template <class T>
void read(Group& group, std::vector<T> Mesh::*attribute, T otherwise) {
  for (int i = 0; i < group.points; ++i) {
    const std::vector<T>& values = group.mesh[i]->*attribute;
    const T* const at = values.data();
    const std::uint32_t* const v = group.corner[i].vertex;
    if (values.empty()) {
      for (int k = 0; k < 3; ++k) group.put(i, k, otherwise);
    } else {
      group.put(i, 0, at[v[0]]), group.put(i, 1, at[v[1]]), group.put(i, 2, at[v[2]]);
    }
  }
  group.out += static_cast<int>(sizeof(T) / sizeof(float)) * 3 * group.points;
}

void read_tangents(Group& group, int uv_set) {
  for (int i = 0; i < group.points; ++i) {
    const Mesh& mesh = *group.mesh[i];
    const Triangle& t = group.corner[i];
    const float4 made = mesh.tangent.empty() ? face_tangent(mesh, t, uv_set) : float4{};
    for (int k = 0; k < 3; ++k) group.put(i, k, mesh.tangent.empty() ? made : mesh.tangent[t.vertex[k]]);
  }
  group.out += 4 * 3 * group.points;
}

void read_all(Group& group, const Attributes& attributes) {
  if (attributes.position) read(group, &Mesh::position, {});
  if (attributes.normal) read(group, &Mesh::normal, {});
  if (attributes.tangent) read_tangents(group, attributes.tangent_uv_set);
  if (attributes.uv[0]) read(group, &Mesh::uv0, {});
  if (attributes.uv[1]) read(group, &Mesh::uv1, {});
  if (attributes.color) read(group, &Mesh::color, {1, 1, 1, 1});
}

bool all_same(const std::uint32_t* values) {
  std::uint32_t difference = 0;
  for (int i = 1; i < Batch::group; ++i) difference |= values[i] ^ values[0];
  return difference == 0;
}

}  // namespace

void fetch_corners(const Scene& scene, const Batch& batch, const Attributes& attributes, Corners& out) {
  const int groups = batch.padded() / Batch::group;
  for (int g = 0; g < groups; ++g) {
    const std::size_t first = static_cast<std::size_t>(g * Batch::group);
    const bool one_triangle = all_same(batch.triangle + first);
    out.one_triangle[g] = one_triangle;
    out.one_instance[g] = one_triangle || all_same(batch.instance + first);
    if (!attributes.any()) continue;

    Group group;
    group.points = one_triangle ? 1 : Batch::group;
    group.out = out.block[g];
    for (int i = 0; i < group.points; ++i) {
      const std::size_t at = first + static_cast<std::size_t>(i);
      group.mesh[i] = &scene.meshes[static_cast<std::size_t>(scene.instances[batch.instance[at]].mesh)];
      group.corner[i] = {{batch.vertex[0][at], batch.vertex[1][at], batch.vertex[2][at]}};
    }
    read_all(group, attributes);
  }
}

Interpolation interpolation(const Attributes& attributes, Points& p) {
  Interpolation what;
  const auto add = [&](Points::Array* arrays, int count) {
    for (int c = 0; c < count; ++c) what.value[what.channels++] = arrays[c];
  };
  if (attributes.position) add(p.position, 3);
  if (attributes.normal) add(p.normal, 3);
  if (attributes.tangent) add(p.tangent, 4);
  for (int set = 0; set < 2; ++set) {
    if (!attributes.uv[set]) continue;
    for (int c = 0; c < 2; ++c) {
      what.dx[what.channels + c] = p.uv_dx[set][c];
      what.dy[what.channels + c] = p.uv_dy[set][c];
    }
    add(p.uv[set], 2);
  }
  if (attributes.color) add(p.color, 4);
  return what;
}

void mark_lit(const Scene& scene, const Batch& batch, float* is_lit) {
  for (int i = 0; i < batch.padded(); ++i) {
    const Instance& instance = scene.instances[batch.instance[i]];
    is_lit[i] = scene.meshes[static_cast<std::size_t>(instance.mesh)].normal.empty() ? 0.0f : 1.0f;
  }
}

std::vector<Placement> make_placements(std::span<const Instance> instances) {
  std::vector<Placement> placements;
  placements.reserve(instances.size());
  for (const Instance& instance : instances) {
    Placement p{};
    const float4x4& world = instance.world_from_object;
    const float4x4 normal = normal_matrix(world);

    // Cofactors of tiny or huge placements are brought near 1, so that their squares stay in range; those that are out
    // of range themselves count as none.
    float greatest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float4 v = normal.column[c];
      greatest = std::max({greatest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    }
    const bool is_in_range = greatest > 1e-36f && greatest < 1e36f;
    const auto put = [](float4 v, float* to) { to[0] = v.x, to[1] = v.y, to[2] = v.z; };
    for (std::size_t c = 0; c < 4; ++c) put(world.column[c], p.world_from_object + 3 * c);
    for (std::size_t c = 0; c < 3; ++c)
      if (is_in_range) put(normal.column[c] * (1 / greatest), p.normal + 3 * c);
    p.handedness = determinant3(world) < 0 ? -1.0f : 1.0f;
    placements.push_back(p);
  }
  return placements;
}

}  // namespace zoneplate
