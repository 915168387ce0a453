// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/scene_shadows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/shade/cast/ground.h"
#include "zoneplate/shade/shadow/receivers.h"
#include "zoneplate/shade/surface/vertices.h"

namespace zoneplate {
namespace {

/// A quarter of the scene's diagonal.
float default_distance(const Scene& scene) {
  const Box box = scene.bounds();
  return box.empty() ? 1 : std::max(length(box.size()) / 4, 1e-30f);
}

/// A camera at `eye` that looks along the unit vector `forward`.
Camera camera_along(float3 eye, float3 forward) {
  const float3 right = normalize(cross(forward, std::abs(forward.y) < 0.9f ? float3{0, 1, 0} : float3{1, 0, 0}));
  const float3 up = cross(right, forward);
  Camera camera;
  camera.world_from_camera = {{float4{right.x, right.y, right.z, 0}, float4{up.x, up.y, up.z, 0},
                               float4{-forward.x, -forward.y, -forward.z, 0}, float4{eye.x, eye.y, eye.z, 1}}};
  return camera;
}

/// The distances along the view axis of a frame's first samples; infinite where there is no surface.
Plane<float> distances_of(const Frame& frame, const float4x4& clip_from_camera) {
  const double zz = clip_from_camera.column[2].z, zw = clip_from_camera.column[3].z;
  const double wz = clip_from_camera.column[2].w, ww = clip_from_camera.column[3].w;
  Plane<float> out(frame.sample_depth[0].width(), frame.sample_depth[0].height(),
                   std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    const double z = frame.sample_depth[0].values()[i];
    if (frame.sample_triangle[0].values()[i] != Frame::no_id)
      out.values()[i] = static_cast<float>((z * ww - zw) / (z * wz - zz));
  }
  return out;
}

ShadowMap render_map(const PreparedScene& prepared, const Camera& camera, int size) {
  Request request;
  request.content = Content::Visibility;
  request.planes.samples = true;
  const Frame frame = render(prepared, camera, request, {.width = size, .height = size, .cull_back_faces = false});
  const float4x4& world = camera.world_from_camera;
  const float4x4 clip_from_camera = camera.clip_from_camera(1);
  ShadowMap map;
  map.eye = xyz(world.column[3]);
  map.right = xyz(world.column[0]), map.up = xyz(world.column[1]), map.forward = -xyz(world.column[2]);
  map.is_perspective = !camera.is_orthographic;
  map.scale = clip_from_camera.column[0].x * static_cast<float>(size) / 2;
  map.farthest = camera.far;
  map.depth = distances_of(frame, clip_from_camera);
  return map;
}

/// The square that encloses the scene, seen along the light.
Camera directional_camera(const Box& box, float3 direction) {
  const float diagonal = length(box.size());
  Camera camera = camera_along(box.centre() - direction * diagonal, direction);
  camera.is_orthographic = true;
  const float3 right = xyz(camera.world_from_camera.column[0]), up = xyz(camera.world_from_camera.column[1]);
  camera.half_height = 0;
  for (int i = 0; i < 8; ++i) {
    const float3 corner = box.corner(i) - box.centre();
    camera.half_height =
        std::max({camera.half_height, std::abs(dot(corner, right)) * 1.01f, std::abs(dot(corner, up)) * 1.01f});
  }
  camera.near = diagonal / 4, camera.far = diagonal * 7 / 4;
  return camera;
}

/// The cameras of a point or spot light. Sides of a cube overlap, so that filters need not cross their borders.
std::vector<Camera> local_cameras(const Box& box, const Light& light) {
  float farthest = 0;
  for (int i = 0; i < 8; ++i) farthest = std::max(farthest, length(box.corner(i) - light.position));
  constexpr float widest_spot = 1.2f, overlapping = 1.65f;  // radians
  std::vector<Camera> cameras;
  const auto add = [&](float3 forward, float fov) {
    Camera& camera = cameras.emplace_back(camera_along(light.position, forward));
    camera.vertical_fov = fov;
    camera.far = farthest * 1.01f, camera.near = farthest * 1e-4f;
  };
  if (light.kind == LightKind::Spot && light.outer_cone < widest_spot) {
    add(normalize(light.direction, {0, 0, -1}), 2 * light.outer_cone + 0.02f);
    return cameras;
  }
  for (const float3 axis : {float3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
    add(axis, overlapping);
  return cameras;
}

/// What pixels show of the scene's surfaces, transparent ones included.
ReceiversOfPixels find_surfaces(const PreparedScene& prepared, const Bvh& bvh, const ReceiversViewer& viewer,
                                const LinesOfSight& lines) {
  return [=, &prepared, &bvh](std::span<const PixelPosition> pixels, Receivers& out, std::span<bool> found) {
    const Scene& scene = prepared.scene();
    std::array<Ray, FragmentBatch::capacity> rays;
    std::array<RayHit, FragmentBatch::capacity> hits;
    for (std::size_t i = 0; i < pixels.size(); ++i) rays[i] = lines.through_centre(pixels[i]);
    RayKernels::of().nearest(view_of(bvh), rays.data(), pixels.size(), hits.data());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      found[i] = hits[i].primitive != RayHit::none;
      if (!found[i]) continue;
      const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[hits[i].instance].mesh)];
      const auto record = [&](std::size_t k) {
        return prepared.vertices().of_instance(hits[i].instance) +
               static_cast<std::size_t>(prepared.vertices().layout(mesh.material).floats) *
                   mesh.index[std::size_t{3} * hits[i].primitive + k];
      };
      make_receiver(scene, hits[i], {record(0), record(1), record(2)}, viewer, pixels[i], out, i);
    }
  };
}

/// What they show of the ground's plane, whatever hides it.
ReceiversOfPixels find_ground(const Scene& scene, const LinesOfSight& lines) {
  return
      [=, square = GroundSquare(scene)](std::span<const PixelPosition> pixels, Receivers& out, std::span<bool> found) {
        for (std::size_t i = 0; i < pixels.size(); ++i) {
          const Ray ray = lines.through_centre(pixels[i]);
          const float3 origin{ray.origin[0], ray.origin[1], ray.origin[2]};
          const float3 direction{ray.direction[0], ray.direction[1], ray.direction[2]};
          const float t = dot(square.corner[0] - origin, square.up) / dot(direction, square.up);
          const float3 at = origin + direction * t;
          found[i] = t > 0 && is_finite(at);
          const auto store = [i](float3 from, float(&to)[3][Receivers::capacity]) {
            to[0][i] = from.x, to[1][i] = from.y, to[2][i] = from.z;
          };
          store(at, out.position), store(square.up, out.face), store(square.up, out.normal);
          store({}, out.dx), store({}, out.dy);
          out.margin[i] = square.margin;
          store_image_position(256 * pixels[i].x + 128, 256 * pixels[i].y + 128, out, i);
          out.surface[i] = 0;
        }
      };
}

}  // namespace

LinesOfSight::LinesOfSight(const Camera& camera, const float4x4& clip_from_camera, const RenderOptions& options) {
  const float4x4& m = clip_from_camera;
  const float4x4& world = camera.world_from_camera;
  const float3 right = xyz(world.column[0]), up = xyz(world.column[1]), ahead = -xyz(world.column[2]);
  // In clip space, pixel x is 2 x / width - 1, and y is 1 - 2 y / height.
  const float3 dx = right * (2 / (m.column[0].x * static_cast<float>(options.width)));
  const float3 dy = up * (-2 / (m.column[1].y * static_cast<float>(options.height)));
  const auto first = [&](float x, float y) {
    return right * ((-1 - x) / m.column[0].x) + up * ((1 - y) / m.column[1].y);
  };
  origin = xyz(world.column[3]), direction = ahead;
  if (camera.is_orthographic) {
    origin = origin + first(m.column[3].x, m.column[3].y);
    origin_dx = dx, origin_dy = dy;
  } else {
    direction = direction + first(-m.column[2].x, -m.column[2].y);
    direction_dx = dx, direction_dy = dy;
  }
}

Ray LinesOfSight::through_centre(PixelPosition pixel) const {
  const float x = static_cast<float>(pixel.x) + 0.5f, y = static_cast<float>(pixel.y) + 0.5f;
  const float3 o = origin + origin_dx * x + origin_dy * y, d = direction + direction_dx * x + direction_dy * y;
  return {{o.x, o.y, o.z}, {d.x, d.y, d.z}};
}

std::vector<std::vector<ShadowMap>> make_shadow_maps(const PreparedScene& prepared, const std::vector<Light>& lights,
                                                     int size) {
  std::vector<std::vector<ShadowMap>> maps;
  Box box = prepared.scene().bounds();
  if (box.empty()) box.add(float3{0, 0, 0});
  if (length(box.size()) == 0) box.add(box.low + float3{1, 1, 1});
  growing("shadow maps", [&] {
    for (const Light& light : lights) {
      std::vector<ShadowMap>& of_light = maps.emplace_back();
      if (light.kind == LightKind::Directional)
        of_light.push_back(render_map(prepared, directional_camera(box, normalize(light.direction, {0, 0, -1})), size));
      else
        for (const Camera& camera : local_cameras(box, light)) of_light.push_back(render_map(prepared, camera, size));
    }
  });
  return maps;
}

const LightVisibility* SceneShadows::of_frame(const PreparedScene& prepared, const ViewUniforms& view,
                                              const LinesOfSight& lines, const RenderOptions& options) {
  if (!has_visibility(options)) return nullptr;
  const bool has_maps = options.shadows.method == ShadowMethod::Map;
  const LightVisibility* traced = nullptr;
  if (!has_maps || options.occlusion.samples > 0) {
    if (scene_ != prepared.shared_scene()) {
      scene_ = nullptr;
      bvh_.emplace(make_casters(prepared.scene()));
      scene_ = prepared.shared_scene();
    }
    OcclusionOptions occlusion = options.occlusion;
    if (occlusion.distance == 0) occlusion.distance = default_distance(*scene_);
    opacity_.emplace(*scene_, prepared.textures());
    traced = &traced_.emplace(*bvh_, opacity_->of_hits(), view.lights, options.shadows, occlusion,
                              view.map ? &*view.map : nullptr);
    const bool is_shared = std::max(options.shadows.spacing, occlusion.spacing) > 1;
    if (is_shared && options.shading_frequency == ShadingFrequency::Fragment)
      traced = &shared_.emplace(
          *traced_, static_cast<int>(view.lights.size()), options.shadows, occlusion,
          SharedVisibility::Image{
              options.width, options.height,
              find_surfaces(prepared, *bvh_, {view.eye, -view.view_direction, view.is_orthographic}, lines),
              find_ground(*scene_, lines)});
  }
  if (!has_maps) return traced;
  return &mapped_.emplace(view.lights, make_shadow_maps(prepared, view.lights, options.shadows.map.size),
                          options.shadows, traced);
}

}  // namespace zoneplate
