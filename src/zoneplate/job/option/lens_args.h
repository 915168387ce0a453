// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zoneplate/scene/camera.h"

namespace zoneplate {

/// The values of --camera-intrinsics, --camera-distortion and --camera-calibration.
struct LensArgs {
  std::vector<double> intrinsics;  ///< fx, fy, cx, cy, in pixels of the image; empty: none
  std::vector<double> distortion;  ///< 4, 5 or 8 coefficients in OpenCV's order; empty: none
  std::optional<Lens> calibrated;  ///< of a file

  /// The lens of an image; nothing if no option is given.
  /// Errors    ErrorKind::Usage for options that exclude each other, and a calibration of another aspect.
  std::optional<Lens> lens(int width, int height) const;
};

/// "fx,fy,cx,cy": focal lengths that are positive.
/// Errors    ErrorKind::Usage.
std::vector<double> parse_intrinsics(const std::string& text);
/// "k1,k2,p1,p2", "k1,k2,p1,p2,k3" or "k1,k2,p1,p2,k3,k4,k5,k6".
/// Errors    ErrorKind::Usage.
std::vector<double> parse_distortion(const std::string& text);
/// A JSON file as OpenCV's FileStorage writes it: matrices camera_matrix and distortion_coefficients, image_width and
/// image_height.
/// Errors    ErrorKind::Input naming the file and what is missing.
Lens read_calibration(const std::string& path);

}  // namespace zoneplate
