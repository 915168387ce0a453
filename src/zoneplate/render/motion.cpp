// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/affine.h"
#include "zoneplate/raster/fragment/interpolate.h"
#include "zoneplate/raster/geometry/triangle_facing.h"
#include "zoneplate/ray/trace.h"
#include "zoneplate/scene/counterparts.h"
#include "zoneplate/shade/cast/casters.h"
#include "zoneplate/shade/surface/material_plan.h"

namespace zoneplate {
namespace {

/// A position on the screen, in pixels from the image's top-left corner.
using Place = std::array<double, 2>;

/// A point of a primitive: the weights of its vertices, which add up to 1.
struct Mixture {
  std::array<std::uint32_t, 3> vertex{};
  std::array<double, 3> weight{};
};

const Mesh& mesh_of(const Scene& scene, const Instance& instance) {
  return scene.meshes[static_cast<std::size_t>(instance.mesh)];
}

/// The matrix of a moment's camera, its scene, and where that has the instances of the rendered scene.
class Seen {
 public:
  Seen(const Moment& moment, float aspect, const Scene& rendered)
      : clip_from_world(moment.camera.clip_from_camera(aspect) * inverse(moment.camera.world_from_camera)),
        scene(moment.scene.get()),
        rendered_(rendered),
        counterpart_(scene == &rendered ? std::vector<std::uint32_t>() : counterparts(rendered, *scene)) {}

  /// An instance of the rendered scene at this moment; null if the scene lacks it, or has another mesh there.
  const Instance* find(std::uint32_t instance) const {
    const std::uint32_t there = scene == &rendered_ ? instance : counterpart_[instance];
    if (there == no_instance) return nullptr;
    const Instance& found = scene->instances[there];
    const Mesh &mesh = mesh_of(*scene, found), &like = mesh_of(rendered_, rendered_.instances[instance]);
    return mesh.position.size() == like.position.size() && mesh.topology == like.topology ? &found : nullptr;
  }

  float4x4 clip_from_world;
  const Scene* scene;

 private:
  const Scene& rendered_;
  std::vector<std::uint32_t> counterpart_;
};

/// The position on the screen in pixels; nothing for a point behind the eye.
std::optional<Place> on_screen(const float4x4& clip_from_world, double3 p, Viewport viewport) {
  const auto& c = clip_from_world.column;
  const auto row = [&](float a, float b, float e, float d) { return ((a * p.x + b * p.y) + e * p.z) + d; };
  const double w = row(c[0].w, c[1].w, c[2].w, c[3].w);
  if (!(w > 0)) return std::nullopt;
  const double x = row(c[0].x, c[1].x, c[2].x, c[3].x) / w, y = row(c[0].y, c[1].y, c[2].y, c[3].y) / w;
  return Place{(x + 1) * viewport.width / 2, (1 - y) * viewport.height / 2};
}

/// Finds the surface points of a frame's pixels.
class PointFinder {
 public:
  PointFinder(const Seen& now, Viewport viewport) : now_(now), viewport_(viewport) {
    for (const Instance& instance : now.scene->instances)
      clip_from_object_.push_back(now.clip_from_world * instance.world_from_object);
  }

  /// The point of a primitive that is visible at a position of the image.
  Mixture find(std::uint32_t instance, std::uint32_t primitive, Place place) const {
    const Scene& scene = *now_.scene;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[instance].mesh)];
    const auto corners = static_cast<std::size_t>(mesh.vertices_per_primitive());
    Mixture out;
    for (std::size_t k = 0; k < 3; ++k) out.vertex[k] = mesh.index[primitive * corners + std::min(k, corners - 1)];
    std::array<float4, 3> clip;
    for (std::size_t k = 0; k < 3; ++k) {
      const float3 p = mesh.position[out.vertex[k]];
      clip[k] = clip_from_object_[instance] * float4{p.x, p.y, p.z, 1};
    }
    out.weight = corners == 3   ? triangle_weights(clip, place)
                 : corners == 2 ? line_weights(clip[0], clip[1], place)
                                : Weights{1, 0, 0};
    return out;
  }

 private:
  using Weights = std::array<double, 3>;

  Weights triangle_weights(const std::array<float4, 3>& clip, Place place) const {
    const BarycentricPlanes planes = barycentric_planes(clip[0], clip[1], clip[2], viewport_);
    // `place` is in pixels from the image's corner; the planes are in 1/256 pixel from its centre.
    const double px = 256 * (place[0] - viewport_.width / 2.0), py = 256 * (place[1] - viewport_.height / 2.0);
    Weights q{};
    for (std::size_t k = 0; k < 3; ++k) q[k] = (planes.x[k] * px + planes.y[k] * py) + planes.one[k];
    const double sum = (q[0] + q[1]) + q[2];
    const Weights weights = sum == 0 ? Weights{1, 0, 0} : Weights{q[0] / sum, q[1] / sum, q[2] / sum};
    return std::min({weights[0], weights[1], weights[2]}) >= 0 ? weights : outline_weights(clip, place, weights);
  }

  /// Coverage rounds vertices to 1/256 pixel: a sample that is outside by less becomes the nearest point of the
  /// outline.
  Weights outline_weights(const std::array<float4, 3>& clip, Place place, Weights outside) const {
    double least = std::numeric_limits<double>::infinity();
    Weights best{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const std::optional<OnSegment> found = nearest_on_segment(clip[k], clip[next], place);
      if (!found || !(found->square < least)) continue;
      least = found->square;
      best = {};
      best[k] = 1 - found->weight, best[next] = found->weight;
    }
    if (least < std::numeric_limits<double>::infinity()) return best;
    for (double& b : outside) b = std::max(b, 0.0);
    const double sum = (outside[0] + outside[1]) + outside[2];
    return {outside[0] / sum, outside[1] / sum, outside[2] / sum};
  }

  Weights line_weights(float4 a, float4 b, Place place) const {
    const std::optional<OnSegment> found = nearest_on_segment(a, b, place);
    return found ? Weights{1 - found->weight, found->weight, 0} : Weights{1, 0, 0};
  }

  struct OnSegment {
    double weight = 0;  ///< of b, in space
    double square = 0;  ///< of the distance on the screen
  };
  /// The point of a segment that is nearest to a position on the screen; nothing if an end is behind the eye.
  std::optional<OnSegment> nearest_on_segment(float4 a, float4 b, Place place) const {
    if (!(a.w > 0) || !(b.w > 0)) return std::nullopt;
    const auto on_screen = [&](float4 p) -> Place {
      return {(1.0 * p.x / p.w + 1) * viewport_.width / 2, (1 - 1.0 * p.y / p.w) * viewport_.height / 2};
    };
    const Place from = on_screen(a), to = on_screen(b);
    const double dx = to[0] - from[0], dy = to[1] - from[1], square = dx * dx + dy * dy;
    const double along = (place[0] - from[0]) * dx + (place[1] - from[1]) * dy;
    const double s = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
    const double ox = place[0] - (from[0] + s * dx), oy = place[1] - (from[1] + s * dy);
    const double at_a = (1 - s) / a.w, at_b = s / b.w;
    return OnSegment{at_b / (at_a + at_b), ox * ox + oy * oy};
  }

  const Seen& now_;
  Viewport viewport_;
  std::vector<float4x4> clip_from_object_;
};

/// The world position of a weighted point of an instance at a moment; nothing if the moment lacks it.
std::optional<double3> place_of(const Mixture& point, std::uint32_t instance, const Seen& seen) {
  const Instance* const placed = seen.find(instance);
  if (placed == nullptr) return std::nullopt;
  const Mesh& mesh = mesh_of(*seen.scene, *placed);
  double3 sum;
  for (std::size_t k = 0; k < 3; ++k) {
    const float3 p = mesh.position[point.vertex[k]];
    const double weight = point.weight[k];
    sum = {sum.x + weight * p.x, sum.y + weight * p.y, sum.z + weight * p.z};
  }
  return transform_point(widened(placed->world_from_object), sum);
}

/// The way in texture coordinates, before any map, from a point at one moment to the point that has the same texel at
/// another one: matrix * uv + offset.
struct TextureStep {
  double xx = 1, xy = 0, yx = 0, yy = 1, x = 0, y = 0;
  int uv_set = 0;
};

/// The whole repetitions of an image do not count: an offset that returns from 1 to 0 is no motion.
double without_repetitions(double offset, Wrap wrap) {
  const double period = wrap == Wrap::Repeat ? 1 : wrap == Wrap::Mirror ? 2 : 0;
  return period > 0 ? offset - period * std::floor(offset / period + 0.5) : offset;
}

/// Of every material whose base colour's texture moves over its surfaces between two moments.
std::vector<std::optional<TextureStep>> texture_steps(const Scene& now, const Scene& other) {
  std::vector<std::optional<TextureStep>> out(now.materials.size());
  for (std::size_t i = 0; i < std::min(out.size(), other.materials.size()); ++i) {
    const TextureUse &here = now.materials[i].base_color_texture, &there = other.materials[i].base_color_texture;
    const bool is_same = here.image >= 0 && here.image == there.image && here.uv_set == there.uv_set;
    if (!is_same || (here.offset == there.offset && here.scale == there.scale && here.rotation == there.rotation))
      continue;
    const CoordinateMap map = coordinate_map(here), back = coordinate_map(there);
    const auto &a = map.m, &b = back.m;
    const double determinant = 1.0 * b[0] * b[4] - 1.0 * b[1] * b[3];
    if (determinant == 0) continue;
    const double x = without_repetitions(1.0 * a[2] - b[2], here.sampler.wrap_u);
    const double y = without_repetitions(1.0 * a[5] - b[5], here.sampler.wrap_v);
    const auto u_of = [&](double mapped_u, double mapped_v) {
      return (b[4] * mapped_u - b[1] * mapped_v) / determinant;
    };
    const auto v_of = [&](double mapped_u, double mapped_v) {
      return (b[0] * mapped_v - b[3] * mapped_u) / determinant;
    };
    out[i] = TextureStep{.xx = u_of(a[0], a[3]),
                         .xy = u_of(a[1], a[4]),
                         .yx = v_of(a[0], a[3]),
                         .yy = v_of(a[1], a[4]),
                         .x = u_of(x, y),
                         .y = v_of(x, y),
                         .uv_set = here.uv_set};
  }
  return out;
}

/// The point of a triangle's plane to which its texture's step leads from `point`.
Mixture after_step(const Mixture& point, const Mesh& mesh, const TextureStep& step) {
  const std::vector<float2>& uv = step.uv_set == 0 ? mesh.uv0 : mesh.uv1;
  if (mesh.topology != Topology::Triangles || uv.empty()) return point;
  const float2 a = uv[point.vertex[0]], b = uv[point.vertex[1]], c = uv[point.vertex[2]];
  const double bx = 1.0 * b.x - a.x, by = 1.0 * b.y - a.y, cx = 1.0 * c.x - a.x, cy = 1.0 * c.y - a.y;
  const double determinant = bx * cy - by * cx;
  if (determinant == 0) return point;
  const double u = a.x + (point.weight[1] * bx + point.weight[2] * cx);
  const double v = a.y + (point.weight[1] * by + point.weight[2] * cy);
  const double dx = ((step.xx * u + step.xy * v) + step.x) - a.x, dy = ((step.yx * u + step.yy * v) + step.y) - a.y;
  const double at_b = (dx * cy - dy * cx) / determinant, at_c = (bx * dy - by * dx) / determinant;
  return {point.vertex, {(1 - at_b) - at_c, at_b, at_c}};
}

/// A point at a moment.
struct PointAt {
  const Seen& seen;
  const Mixture& point;
};

/// The motion on the screen from a point at one moment to a point at another.
float2 step_between(const PointAt& from, const PointAt& to, std::uint32_t instance, Viewport viewport) {
  const auto at = [&](const PointAt& p) -> std::optional<Place> {
    const std::optional<double3> place = place_of(p.point, instance, p.seen);
    return place ? on_screen(p.seen.clip_from_world, *place, viewport) : std::nullopt;
  };
  const auto start = at(from), end = at(to);
  if (!start || !end) return {0, 0};
  return {static_cast<float>((*end)[0] - (*start)[0]), static_cast<float>((*end)[1] - (*start)[1])};
}

}  // namespace

void add_surface_points(const Moment& now, const Planes& planes, const RenderOptions& options, Frame& frame) {
  const int width = frame.instance.width(), height = frame.instance.height();
  const Viewport viewport{options.width, options.height};
  const float aspect = aspect_of(options);
  const Scene& scene = *now.scene;
  const Seen seen(now, aspect, scene), last(options.last ? *options.last : now, aspect, scene),
      next(options.next ? *options.next : now, aspect, scene);
  const PointFinder finder(seen, viewport);
  const auto last_steps = texture_steps(scene, *last.scene), next_steps = texture_steps(scene, *next.scene);
  if (planes.position) frame.position = {width, height, float3{}};
  if (planes.motion) frame.motion = {width, height, float2{}};
  if (planes.flow) frame.flow = {width, height, float2{}};
  if (planes.last_position || planes.was_visible) frame.last_position = {width, height, float3{}};

  parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const std::uint32_t instance = frame.instance(x, y);
      if (instance == Frame::no_id) continue;
      const SamplePosition place = frame.data_position(x, y);
      const Mixture point = finder.find(instance, frame.primitive_id(x, y),
                                        {frame.x + x + place.x / 256.0, frame.y + y + place.y / 256.0});
      const Mesh& mesh = mesh_of(scene, scene.instances[instance]);
      if (planes.position) frame.position(x, y) = narrowed(*place_of(point, instance, seen));
      const auto material = static_cast<std::size_t>(mesh.material);
      const auto stepped = [&](const auto& steps) {
        return steps[material] ? after_step(point, mesh, *steps[material]) : point;
      };
      const Mixture last_point = stepped(last_steps);
      if (!frame.last_position.empty()) {
        const std::optional<double3> before = place_of(last_point, instance, last);
        frame.last_position(x, y) = narrowed(before ? *before : *place_of(point, instance, seen));
      }
      if (planes.motion) frame.motion(x, y) = step_between({last, last_point}, {seen, point}, instance, viewport);
      if (planes.flow) frame.flow(x, y) = step_between({seen, point}, {next, stepped(next_steps)}, instance, viewport);
    }
  });
}

// A ray from the eye ends before the surface point itself, by more than the rounding of the point.
void LastVisibility::find(const Moment& now, const TextureSet& textures, const RenderOptions& options, Frame& frame) {
  const Moment& last = options.last ? *options.last : now;
  constexpr float end = 1 - 0x1p-12f;
  if (scene_ != last.scene) {
    scene_ = nullptr;
    bvh_.emplace(make_casters(*last.scene));
    scene_ = last.scene;
  }
  const CasterOpacity opacity(*scene_, textures);
  const float4x4& world = last.camera.world_from_camera;
  const float3 eye = xyz(world.column[3]), forward = -xyz(world.column[2]);
  const Seen seen(last, aspect_of(options), *now.scene);
  const Viewport viewport{options.width, options.height};
  const auto is_in_image = [&](float3 p) {
    const std::optional<Place> place = on_screen(seen.clip_from_world, {p.x, p.y, p.z}, viewport);
    return place && (*place)[0] >= 0 && (*place)[1] >= 0 && (*place)[0] <= options.width &&
           (*place)[1] <= options.height;
  };
  const int width = frame.last_position.width(), height = frame.last_position.height();
  frame.was_visible = {width, height, std::uint8_t{0}};
  parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::vector<Ray> rays;
    std::vector<int> columns;
    for (int x = 0; x < width; ++x) {
      const std::uint32_t instance = frame.instance(x, y);
      const float3 point = frame.last_position(x, y);
      if (instance == Frame::no_id || seen.find(instance) == nullptr || !is_in_image(point)) continue;
      const float3 from = last.camera.is_orthographic ? point - forward * dot(point - eye, forward) : eye;
      const float3 along = point - from;
      rays.push_back({{from.x, from.y, from.z}, {along.x, along.y, along.z}, end});
      columns.push_back(x);
    }
    std::vector<float> visibility(rays.size());
    RayKernels::of().visibility(view_of(*bvh_), rays.data(), rays.size(), opacity.of_hits(), visibility.data());
    for (std::size_t i = 0; i < columns.size(); ++i) frame.was_visible(columns[i], y) = visibility[i] > 0.5f;
  });
}

}  // namespace zoneplate
