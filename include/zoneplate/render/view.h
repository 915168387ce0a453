#pragma once

#include <optional>

#include "zoneplate/base/api.h"
#include "zoneplate/scene/scene.h"

namespace ZONEPLATE_API zoneplate {

/// Which camera a picture has; angles in radians.
struct View {
  std::optional<int> index;                 ///< a camera of the scene
  std::optional<float3> position;           ///< of the eye, in world space
  std::optional<float3> focal_point;        ///< the point that the camera looks at
  std::optional<float3> view_up;            ///< the direction that is upwards in the image
  std::optional<float> view_angle;          ///< vertical field of view
  std::optional<float> azimuth, elevation;  ///< of the whole-scene view, or a turn about the focal point
  bool is_orthographic = false;             ///< a parallel projection that shows the same height at the focal point
  float3 up{0, 1, 0};                       ///< the scene's upward axis
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
