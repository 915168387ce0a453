// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/displacement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "zoneplate/math/elementary.h"
#include "zoneplate/scene/geometry/displace.h"
#include "zoneplate/scene/geometry/tangent.h"

namespace zoneplate {
namespace {

float red_of(Rgba8 p) { return static_cast<float>(p.r) / 255; }
float red_of(Rgba16 p) { return static_cast<float>(p.r) / 65535; }
float red_of(float4 p) { return p.x > 0 ? std::min(p.x, 1.0f) : 0.0f; }

/// The texel of an index that may lie outside of [0, size).
int wrapped(std::int64_t i, int size, Wrap wrap) {
  const std::int64_t n = size;
  if (wrap == Wrap::Clamp) return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t period = wrap == Wrap::Mirror ? 2 * n : n;
  const std::int64_t at = ((i % period) + period) % period;
  return static_cast<int>(at < n ? at : period - 1 - at);
}

/// A coordinate in texels. Coordinates beyond 2^30 texels count as 2^30.
float bounded(float x) { return std::clamp(x, -0x1p30f, 0x1p30f); }

/// The bilinear look-up of the red channel of level 0, at coordinates after the texture's transform.
float height_at(const TexelImage& image, const Sampler& sampler, float2 uv) {
  return image.visit([&](const auto& plane) {
    const float x = bounded(uv.x * static_cast<float>(plane.width()) - 0.5f);
    const float y = bounded(uv.y * static_cast<float>(plane.height()) - 0.5f);
    const float left = std::floor(x), top = std::floor(y), s = x - left, t = y - top;
    const auto texel = [&](int dx, int dy) {
      return red_of(plane(wrapped(static_cast<std::int64_t>(left) + dx, plane.width(), sampler.wrap_u),
                          wrapped(static_cast<std::int64_t>(top) + dy, plane.height(), sampler.wrap_v)));
    };
    return (texel(0, 0) * (1 - s) + texel(1, 0) * s) * (1 - t) + (texel(0, 1) * (1 - s) + texel(1, 1) * s) * t;
  });
}

/// KHR_texture_transform's map of coordinates: scale, rotation, offset.
float2 transformed(const TextureUse& use, float2 uv) {
  const float c = cos(use.rotation), s = sin(use.rotation);
  const float2 at = uv * use.scale;
  return float2{at.x * c + at.y * s, at.y * c - at.x * s} + use.offset;
}

float longest_side(const Mesh& mesh) {
  Box box;
  for (const float3 p : mesh.position) box.add(p);
  return std::max({box.size().x, box.size().y, box.size().z});
}

bool is_displaced(const Mesh& mesh, const Material& material) {
  const bool has_coordinates = !(material.height_texture.uv_set == 1 ? mesh.uv1 : mesh.uv0).empty();
  return mesh.topology == Topology::Triangles && !mesh.index.empty() && has_coordinates && !mesh.normal.empty() &&
         material.height_texture.image >= 0 && material.height_scale != 0;
}

}  // namespace

void displace_surfaces(Scene& scene, const DisplacementOptions& options) {
  for (Mesh& mesh : scene.meshes) {
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (!is_displaced(mesh, material)) continue;
    const TextureUse& use = material.height_texture;
    const TexelImage& image = scene.images[static_cast<std::size_t>(use.image)].pixels;
    // The refinement reads the coordinates in uv0.
    const bool is_second = use.uv_set == 1, has_tangents = !mesh.tangent.empty();
    if (is_second) std::swap(mesh.uv0, mesh.uv1);
    const HeightMap map{
        [&](float2 uv) { return material.height_scale * height_at(image, use.sampler, transformed(use, uv)); },
        float2{static_cast<float>(image.width()), static_cast<float>(image.height())} * use.scale};
    Displaced displaced = displace(
        mesh, map, {.tolerance = options.tolerance * longest_side(mesh), .max_triangles = options.max_triangles});
    mesh = std::move(displaced.mesh);
    if (is_second) std::swap(mesh.uv0, mesh.uv1);
    if (has_tangents) make_tangents(mesh, material.normal_texture.uv_set);
    if (!displaced.is_complete)
      scene.warnings.push_back("mesh " + mesh.name + ": displaced more coarsely than the tolerance, at most " +
                               std::to_string(options.max_triangles) + " triangles");
  }
  for (Material& material : scene.materials) material.height_texture = {}, material.parallax_layers = 0;
}

}  // namespace zoneplate
