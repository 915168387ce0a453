#include "zoneplate/render/surfaces.h"

#include <cmath>

namespace zoneplate {
namespace {

/// Half a pixel's worth of clip space a unit of w, times `pixels`.
float2 half_extent(float pixels, const RenderOptions& o) {
  return {pixels / static_cast<float>(o.width), pixels / static_cast<float>(o.height)};
}

/// The unit direction of a segment on the screen, in pixels, from what of it is in front of the eye.
float2 screen_direction(float4 a, float4 b, const RenderOptions& o) {
  constexpr float least_w = 1e-6f;
  const auto toward = [](float4 from, float4 to) {
    const float t = (least_w - from.w) / (to.w - from.w);
    return from + (to - from) * t;
  };
  if (a.w < least_w && b.w < least_w) return {1, 0};
  if (a.w < least_w) a = toward(b, a);
  if (b.w < least_w) b = toward(a, b);
  const float2 d{(b.x / b.w - a.x / a.w) * static_cast<float>(o.width),
                 (b.y / b.w - a.y / a.w) * static_cast<float>(o.height)};
  const float n = length(d);
  return n > 0 && std::isfinite(n) ? float2{d.x / n, d.y / n} : float2{1, 0};
}

/// A quad whose corners are moved from `a` (twice) and `b` (twice) by offsets in clip space a unit of w: moving by
/// offset × w is the same on the screen at every depth, and stays a straight line across the eye's plane.
void add_quad(SceneDraws::Quads& q, float4 a, float4 b, std::uint32_t source_a, std::uint32_t source_b,
              const float2 (&offset)[4]) {
  const auto first = static_cast<std::uint32_t>(q.clip.size());
  for (int k = 0; k < 4; ++k) {
    const float4 p = k < 2 ? a : b;
    q.clip.push_back({p.x + offset[k].x * p.w, p.y + offset[k].y * p.w, p.z, p.w});
    q.source.push_back(k < 2 ? source_a : source_b);
  }
  for (const std::uint32_t k : {0u, 1u, 2u, 2u, 1u, 3u}) q.index.push_back(first + k);
}

SceneDraws::Quads make_quads(const Mesh& mesh, const float4x4& clip_from_object, const RenderOptions& options) {
  SceneDraws::Quads out;
  const auto at = [&](std::size_t i) {
    const float3 p = mesh.position[mesh.index[i]];
    return clip_from_object * float4{p.x, p.y, p.z, 1};
  };
  const float2 line = half_extent(options.line_width, options), point = half_extent(options.point_size, options);
  for (std::size_t i = 0; i < mesh.primitives(); ++i) {
    if (mesh.topology == Topology::Points) {
      const float2 corners[4] = {{-point.x, point.y}, {-point.x, -point.y}, {point.x, point.y}, {point.x, -point.y}};
      add_quad(out, at(i), at(i), mesh.index[i], mesh.index[i], corners);
      continue;
    }
    const float4 a = at(2 * i), b = at(2 * i + 1);
    const float2 d = screen_direction(a, b, options);
    const float2 side{-d.y * line.x, d.x * line.y};
    const float2 corners[4] = {side, side * -1, side, side * -1};
    add_quad(out, a, b, mesh.index[2 * i], mesh.index[2 * i + 1], corners);
  }
  return out;
}

Surface surface_of(const Material& material) {
  return material.alpha_mode == AlphaMode::Blend  ? Surface::Blended
         : material.alpha_mode == AlphaMode::Mask ? Surface::Masked
                                                  : Surface::Opaque;
}

}  // namespace

SceneDraws make_draws(const Scene& scene, const float4x4& clip_from_world, const RenderOptions& options) {
  SceneDraws out;
  out.quads.resize(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    Draw draw;
    draw.surface = surface_of(material);
    draw.material = mesh.material;
    draw.instance = static_cast<std::uint32_t>(i);
    draw.clip_from_object = clip_from_world * instance.world_from_object;
    if (mesh.topology == Topology::Triangles) {
      draw.position = mesh.position;
      draw.index = mesh.index;
      draw.culls_back_faces = options.cull_back_faces && !material.double_sided;
      draw.is_mirrored = determinant3(instance.world_from_object) < 0;
    } else {
      out.quads[i] = make_quads(mesh, draw.clip_from_object, options);
      draw.clip = out.quads[i].clip;
      draw.index = out.quads[i].index;
      draw.source = out.quads[i].source;
      draw.triangles_per_primitive = 2;
    }
    out.draws.push_back(draw);
  }
  return out;
}

}  // namespace zoneplate
