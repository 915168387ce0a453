// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/fit.h"

namespace zoneplate {
namespace {

// A camera by the parameters of the options.
struct Pose {
  float3 eye, target, up;
};

Pose pose_of(const Camera& camera, float3 centre) {
  const float4x4& m = camera.world_from_camera;
  const float3 eye = xyz(m.column[3]), forward = normalize(-xyz(m.column[2]), {0, 0, -1});
  const float distance = dot(centre - eye, forward);
  return {eye, eye + forward * (distance > 0 ? distance : 1.0f), xyz(m.column[1])};
}

// Turns a camera about its focal point: to the right about the up vector, then upwards.
Pose turned(const Pose& pose, float azimuth, float elevation) {
  const float3 sideways = transform_vector(rotation(pose.up, azimuth), pose.eye - pose.target);
  const float3 right = normalize(cross(pose.up, sideways), {1, 0, 0});
  const float4x4 upwards = rotation(right, -elevation);
  return {pose.target + transform_vector(upwards, sideways), pose.target,
          elevation == 0 ? pose.up : transform_vector(upwards, pose.up)};
}

// Reversed floating-point depth has enough precision for a far plane 100,000 times as far as the near one.
constexpr float min_near = 1e-5f;

// Sets near and far around distances along the view axis. An orthographic camera moves back until they are positive;
// returns how far.
float enclose(Camera& camera, AxisRange range) {
  const float3 eye = xyz(camera.world_from_camera.column[3]), back = xyz(camera.world_from_camera.column[2]);
  auto [nearest, farthest] = range;
  const float margin = 0.01f * (farthest - nearest) + 1e-6f * std::max(std::abs(nearest), std::abs(farthest));
  float step = 0;
  if (camera.is_orthographic && nearest - 2 * margin <= 0) {
    step = 3 * margin - nearest;
    const float3 moved = eye + back * step;
    camera.world_from_camera.column[3] = {moved.x, moved.y, moved.z, 1};
    nearest += step, farthest += step;
  }
  camera.far = farthest + margin;
  camera.near = std::max(nearest - margin, camera.far * min_near);
  return step;
}

// Sets near and far around the part of the scene in front of the camera.
void enclose(Camera& camera, const Box& box) {
  const float3 eye = xyz(camera.world_from_camera.column[3]), back = xyz(camera.world_from_camera.column[2]);
  float nearest = std::numeric_limits<float>::infinity(), farthest = -nearest;
  for (int i = 0; i < 8; ++i) {
    const float distance = dot(eye - box.corner(i), back);
    nearest = std::min(nearest, distance);
    farthest = std::max(farthest, distance);
  }
  if (box.empty() || !(farthest > 0 || camera.is_orthographic))
    camera.near = 0.01f, camera.far = 1000;
  else
    enclose(camera, AxisRange{nearest, farthest});
}

AutoFit fit_of(const View& view) {
  AutoFit fit;
  fit.up = view.up;
  fit.is_orthographic = view.is_orthographic;
  if (view.view_angle) fit.vertical_fov = *view.view_angle;
  if (!view.position) {
    if (view.azimuth) fit.azimuth = *view.azimuth;
    if (view.elevation) fit.elevation = *view.elevation;
  }
  return fit;
}

// From behind or from below, where that sees a front face.
View turned_to_front(const Scene& scene, const View& view, float aspect) {
  constexpr float half_turn = 3.14159265f;
  const AutoFit fit = fit_of(view);
  for (const auto& [azimuth, elevation] :
       {std::pair{fit.azimuth + half_turn, fit.elevation}, std::pair{fit.azimuth, -fit.elevation},
        std::pair{fit.azimuth + half_turn, -fit.elevation}}) {
    View other = view;
    other.azimuth = azimuth, other.elevation = elevation;
    if (!sees_backs_alone(scene, fit_camera(scene, aspect, fit_of(other)))) return other;
  }
  return view;
}

/// The vertical angle of the greatest view around the axis that is inside the image; at least a quarter of its height
/// counts, wherever the principal point is.
float angle_around_axis(const Lens& lens, float aspect) {
  const double x = std::min(lens.cx + 0.5, lens.width - lens.cx - 0.5) / lens.fx;
  const double y = std::min(lens.cy + 0.5, lens.height - lens.cy - 0.5) / lens.fy;
  const double slope = std::max(std::min(y, x / static_cast<double>(aspect)), lens.height / lens.fy / 8);
  return 2 * atan2(static_cast<float>(slope), 1.0f);
}

View without_lens(View view, float aspect) {
  view.view_angle = angle_around_axis(*view.lens, aspect);
  view.lens.reset();
  return view;
}

Camera base_camera(const Scene& scene, const View& view, float aspect) {
  if (!view.index) {
    const Camera camera = fit_camera(scene, aspect, fit_of(view));
    if (!is_free(view) || !sees_backs_alone(scene, camera)) return camera;
    return fit_camera(scene, aspect, fit_of(turned_to_front(scene, view, aspect)));
  }
  const int count = static_cast<int>(scene.cameras.size());
  if (*view.index >= count)
    throw Error(ErrorKind::Usage, count == 0 ? "--camera-index: the scene has no camera"
                                             : fmt::format("--camera-index: the scene has cameras 0 to {}, not {}",
                                                           count - 1, *view.index));
  return scene.cameras[static_cast<std::size_t>(*view.index)];
}

}  // namespace

bool is_free(const View& view) {
  return !view.index && !view.position && !view.focal_point && !view.view_up && !view.azimuth && !view.elevation;
}

View facing_front(const Scene& scene, const View& view, float aspect) {
  if (!is_free(view) || !sees_backs_alone(scene, fit_camera(scene, aspect, fit_of(view)))) return view;
  return turned_to_front(scene, view, aspect);
}

std::vector<float3> view_directions(const Box& bounds, const View& view, float aspect) {
  return fit_directions(bounds, aspect, fit_of(view.lens ? without_lens(view, aspect) : view));
}

Camera choose_camera(const Scene& scene, const View& view, float aspect) {
  if (view.lens) {
    Camera camera = choose_camera(scene, without_lens(view, aspect), aspect);
    if (camera.is_orthographic)
      throw Error(ErrorKind::Usage, "a lens has a perspective camera, not an orthographic one");
    camera.lens = view.lens;
    return camera;
  }
  Camera camera = base_camera(scene, view, aspect);
  const bool turns = (view.azimuth || view.elevation) && (view.index || view.position);
  const bool changes_lens = view.index && (view.view_angle || view.is_orthographic);
  if (!view.position && !view.focal_point && !view.view_up && !turns && !changes_lens) return camera;

  const Box box = scene.bounds();
  const float3 centre = box.empty() ? float3{} : box.centre();
  Pose pose = pose_of(camera, centre);
  if (view.position) pose = {scene.in_world(*view.position), centre, view.up};
  if (view.focal_point) pose.target = scene.in_world(*view.focal_point);
  if (view.view_up) pose.up = *view.view_up;
  if (pose.eye == pose.target) throw Error(ErrorKind::Usage, "the camera's position and its focal point are the same");
  if (turns) pose = turned(pose, view.azimuth.value_or(0), view.elevation.value_or(0));
  camera.world_from_camera = inverse(look_at(pose.eye, pose.target, pose.up));

  // An orthographic view has the height of the perspective one at the focal point.
  if (view.view_angle) camera.vertical_fov = *view.view_angle;
  if (view.is_orthographic) {
    const float half_angle = camera.vertical_fov / 2;
    camera.is_orthographic = true;
    camera.half_height = length(pose.eye - pose.target) * sin(half_angle) / cos(half_angle);
  }
  enclose(camera, box);
  return camera;
}

Camera enclosing(Camera camera, const Scene& scene) {
  const std::optional<AxisRange> range = range_along_view(scene, camera);
  if (!range || !(range->farthest > 0 || camera.is_orthographic)) return camera;
  const bool is_before = range->nearest<camera.near, is_behind = range->farthest> camera.far;
  if (!is_before && !is_behind) return camera;
  Camera around = camera;
  const float step = enclose(around, *range);
  around.far = is_behind ? around.far : camera.far + step;
  const float least = camera.is_orthographic ? 0 : around.far * min_near;
  around.near = std::min(camera.near + step, is_before ? std::max(around.near, least) : camera.near + step);
  return around;
}

}  // namespace zoneplate
