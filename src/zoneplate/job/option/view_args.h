// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/render/view.h"

namespace zoneplate {

/// The names of --views.
std::vector<std::string_view> view_names();

/// The direction of a whole-scene view.
struct ViewDirection {
  float azimuth = 0, elevation = 0;  ///< radians, as those of View
};

/// A list of names, "front,right,top,iso".
/// Errors    ErrorKind::Usage for another name.
std::vector<ViewDirection> parse_views(const std::string& text);

/// A pose of the camera at a time in seconds; what it leaves out is that of the view that moves.
struct KeyView {
  double time = 0;
  double3 position = {}, focal_point = {};  ///< in the coordinates of the file
  std::optional<float3> view_up = {};
  std::optional<float> view_angle = {};  ///< radians
};

/// Poses of the camera, by time, between which it moves on smooth curves.
struct KeyedViews {
  std::vector<KeyView> keys;  ///< at least one; their times rise

  /// The view at a time: cubic Hermite curves through the positions and focal points, whose slopes at a key are the
  /// mean velocity between its neighbours; view angle and upward direction are linear. Before the first key and after
  /// the last one the camera rests.
  ///
  /// Source    Catmull and Rom, A Class of Local Interpolating Splines, 1974, here for times that are not uniform.
  View at(double time, View base) const;
};

/// A JSON file {"keys": [{"time": 0, "position": [x, y, z], "focal_point": [x, y, z], ...}]} with `view_up` and
/// `view_angle` (degrees) where they are given.
/// Errors    ErrorKind::Input naming the file and the key.
KeyedViews read_camera_path(const std::string& path);

}  // namespace zoneplate
