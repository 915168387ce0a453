#include "zoneplate/shade/fetch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace zoneplate {
namespace {

/// Where the channels of one corner are written: `stride` apart.
class Writer {
 public:
  Writer(float* out, int stride) : out_(out), stride_(stride) {}
  void put(float value) {
    *out_ = value;
    out_ += stride_;
  }
  void put(float2 v) { put(v.x), put(v.y); }
  void put(float3 v) { put(v.x), put(v.y), put(v.z); }
  void put(float4 v) { put(v.x), put(v.y), put(v.z), put(v.w); }

  /// Value i, or `otherwise` where the mesh has no such attribute.
  template <class T>
  void put(const std::vector<T>& values, std::uint32_t i, T otherwise) {
    put(i < values.size() ? values[i] : otherwise);
  }

 private:
  float* out_;
  int stride_;
};

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

/// `tangent`: of the face, for meshes that have none.
void write_corner(const Mesh& mesh, std::uint32_t vertex, const Attributes& attributes, float4 tangent, Writer out) {
  if (attributes.position) out.put(mesh.position, vertex, float3{});
  if (attributes.normal) out.put(mesh.normal, vertex, float3{});
  if (attributes.tangent) out.put(mesh.tangent, vertex, tangent);
  if (attributes.uv[0]) out.put(mesh.uv0, vertex, float2{});
  if (attributes.uv[1]) out.put(mesh.uv1, vertex, float2{});
  if (attributes.color) out.put(mesh.color, vertex, float4{1, 1, 1, 1});
}

/// Writes a point's three corners, `corner_stride` apart.
void write_point(const Scene& scene, const Batch& batch, std::size_t i, const Attributes& attributes, float* out,
                 int corner_stride, int channel_stride) {
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[batch.instance[i]].mesh)];
  const Triangle t{{batch.vertex[0][i], batch.vertex[1][i], batch.vertex[2][i]}};
  const bool makes_tangent = attributes.tangent && mesh.tangent.empty();
  const float4 tangent = makes_tangent ? face_tangent(mesh, t, attributes.tangent_uv_set) : float4{};
  for (int k = 0; k < 3; ++k) {
    write_corner(mesh, t.vertex[k], attributes, tangent, {out + k * corner_stride, channel_stride});
  }
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
    if (one_triangle) {
      write_point(scene, batch, first, attributes, out.block[g], 1, 3);
      continue;
    }
    for (int i = 0; i < Batch::group; ++i) {
      write_point(scene, batch, first + static_cast<std::size_t>(i), attributes, out.block[g] + i, Batch::group,
                  3 * Batch::group);
    }
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
