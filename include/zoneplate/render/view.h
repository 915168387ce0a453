#pragma once

#include <optional>

#include "zoneplate/base/api.h"
#include "zoneplate/scene/scene.h"

namespace ZONEPLATE_API zoneplate {

/// Which camera a picture has; angles in radians.
struct View {
  std::optional<int> index;  ///< a camera of the scene
  std::optional<float3> position, focal_point, view_up;
  std::optional<float> view_angle, azimuth, elevation;
  bool is_orthographic = false;
  float3 up{0, 1, 0};  ///< the scene's upward axis
};

/// The camera for a picture of the given aspect (width / height).
///
/// One camera is the base: the scene's number `index`, or else the one that shows the whole scene three-quarter from
/// above. Position, focal point, view-up and view angle replace what the base has. Azimuth and elevation choose the
/// direction of the whole-scene view, 0 and 0 being the front; any other camera they turn about its focal point,
/// azimuth to the right and elevation upwards, after everything else. A base camera's focal point is the point on
/// its axis next to the centre of the scene. Near and far enclose the scene, unless the base is used unchanged.
///
/// Errors    ErrorKind::Usage for an index that the scene does not have, or a position equal to the focal point.
Camera choose_camera(const Scene& scene, const View& view, float aspect);

}  // namespace zoneplate
