#include "zoneplate/render/surfaces.h"

#include <cmath>

namespace zoneplate {
namespace {

/// Half a pixel's worth of clip space a unit of w, times `pixels`.
float2 half_extent(float pixels, const RenderOptions& o) {
  return {pixels / static_cast<float>(o.width), pixels / static_cast<float>(o.height)};
}

/// The part of a segment in front of the near plane, as shares of the way from a to b; empty if first > last.
struct Part {
  float first = 0, last = 1;
};

Part part_in_front(float4 a, float4 b) {
  const float da = a.w - a.z, db = b.w - b.z;
  if (da < 0 && db < 0) return {1, 0};
  return {da < 0 ? da / (da - db) : 0, db < 0 ? da / (da - db) : 1};
}

/// The unit direction of a segment on the screen, in pixels, y up.
float2 screen_direction(float4 a, float4 b, const RenderOptions& o) {
  const float2 d{(b.x / b.w - a.x / a.w) * static_cast<float>(o.width),
                 (b.y / b.w - a.y / a.w) * static_cast<float>(o.height)};
  const float n = length(d);
  return n > 0 && std::isfinite(n) ? float2{d.x / n, d.y / n} : float2{1, 0};
}

/// A quad of two corners about a and two about b, moved in clip space by offset × w: the same on the screen at every
/// depth.
void add_quad(SceneDraws::Quads& q, float4 a, float4 b, Part part, const float2 (&offset)[4]) {
  const auto first = static_cast<std::uint32_t>(q.clip.size());
  for (int k = 0; k < 4; ++k) {
    const float4 p = k < 2 ? a : b;
    q.clip.push_back({p.x + offset[k].x * p.w, p.y + offset[k].y * p.w, p.z, p.w});
    q.share.push_back(k < 2 ? part.first : part.last);
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
  const auto corners_of = mesh.topology == Topology::Points ? std::size_t{1} : std::size_t{2};
  for (std::size_t i = 0; i < mesh.primitives(); ++i) {
    const float4 a = at(corners_of * i), b = at(corners_of * i + corners_of - 1);
    out.ends.push_back(mesh.index[corners_of * i]);
    out.ends.push_back(mesh.index[corners_of * i + corners_of - 1]);
    if (mesh.topology == Topology::Points) {
      const float2 corners[4] = {{-point.x, point.y}, {-point.x, -point.y}, {point.x, point.y}, {point.x, -point.y}};
      add_quad(out, a, b, {}, corners);
      continue;
    }
    // What is behind the near plane is cut off before the segment gets its width, which has no meaning there.
    const Part part = part_in_front(a, b);
    const float4 from = a + (b - a) * part.first, to = a + (b - a) * part.last;
    const float2 d = screen_direction(from, to, options);
    const float2 side = part.first > part.last ? float2{} : float2{-d.y * line.x, d.x * line.y};
    const float2 corners[4] = {side, side * -1, side, side * -1};
    add_quad(out, from, to, part, corners);
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
      draw.ends = out.quads[i].ends;
      draw.share = out.quads[i].share;
    }
    out.draws.push_back(draw);
  }
  return out;
}

}  // namespace zoneplate
