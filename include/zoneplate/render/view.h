// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "zoneplate/math/box.h"
#include "zoneplate/scene/scene.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The choice of a camera; angles in radians.
struct View {
  std::optional<int> index{};                   ///< a camera of the scene
  std::optional<double3> position{};            ///< of the eye, in the coordinates of the file (Scene::origin)
  std::optional<double3> focal_point{};         ///< the point that the camera looks at, in the same coordinates
  std::optional<float3> view_up{};              ///< the direction that is upwards in the image
  std::optional<float> view_angle{};            ///< vertical field of view
  std::optional<float> azimuth{}, elevation{};  ///< of the whole-scene view, or a turn about the focal point
  bool is_orthographic = false;                 ///< a parallel projection that shows the same height at the focal point
  std::optional<Lens> lens{};                   ///< replaces `view_angle`; perspective only
  float3 up{0, 1, 0};                           ///< the scene's upward axis
};

/// Whether nothing but the scene decides the direction of a view.
bool is_free(const View& view);

/// The view with the azimuth and elevation that choose_camera takes where a whole-scene view of no given direction
/// would see nothing but back faces; else the same view.
View facing_front(const Scene& scene, const View& view, float aspect);

/// The camera for an image of the given aspect ratio (width / height).
///
/// The base is camera `index` of the scene, or without an index a whole-scene view, three-quarter from above; where
/// that would see nothing but back faces, which are not drawn, it is taken from behind or from below. Position, focal
/// point, view-up and view angle replace those of the base. For the whole-scene view, azimuth and elevation are its
/// direction, 0 and 0 being the front; any other camera is turned by them about its focal point as the last step,
/// azimuth to the right and elevation upwards. The focal point of a base camera is the point on its axis nearest to the
/// centre of the scene. Near and far planes enclose the scene, unless the base is used unchanged. Through a lens
/// a whole-scene view is as far away as its principal point allows, without regard to distortion.
///
/// Errors    ErrorKind::Usage for an index outside the scene's cameras, a position equal to the focal point, or a lens with
///           an orthographic camera.
Camera choose_camera(const Scene& scene, const View& view, float aspect);

/// The directions in which the farthest vertices of a scene with these bounds decide its camera: choose_camera of the
/// scene is that of points with the same bounds and the same farthest ones, in the same order.
///
/// Requires  a view of no camera of the scene, and double-sided surfaces.
std::vector<float3> view_directions(const Box& bounds, const View& view, float aspect);

/// The same view with near and far planes that also enclose the part of a scene in front of the camera. Planes that do
/// so already stay as they are. An orthographic camera moves back until all of the scene is in front of it.
Camera enclosing(Camera camera, const Scene& scene);

}  // namespace zoneplate
#pragma GCC visibility pop
