// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "zoneplate/math/box.h"
#include "zoneplate/math/transform.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// A calibrated lens: OpenCV's camera matrix and its rational and tangential distortion.
///
/// A point (x, y, -1) of camera space, y upwards, has the undistorted coordinates (x, -y) and the distorted ones
/// (x', y'); its pixel is (fx x' + cx, fy y' + cy), where the centre of the top-left pixel is (0, 0).
/// Source    OpenCV 4, camera calibration and 3D reconstruction: projectPoints with eight coefficients.
struct Lens {
  int width = 0, height = 0;                              ///< pixels of the image for which it is calibrated
  double fx = 1, fy = 1;                                  ///< focal lengths, in pixels
  double cx = 0, cy = 0;                                  ///< the principal point, in pixels
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0;  ///< radial: (1 + k1 r² + ...) / (1 + k4 r² + ...)
  double p1 = 0, p2 = 0;                                  ///< tangential
  bool operator==(const Lens&) const = default;

  /// Whether straight lines become curved.
  bool is_distorted() const {
    return k1 != 0 || k2 != 0 || k3 != 0 || k4 != 0 || k5 != 0 || k6 != 0 || p1 != 0 || p2 != 0;
  }
};

/// A camera in the world. It looks along its own -Z with +Y up.
struct Camera {
  std::string name{};               ///< from the file, for listings; may be empty
  float4x4 world_from_camera{};     ///< rigid; the identity by default: at the origin, looking along -Z
  bool is_orthographic = false;     ///< `half_height` then sets the scale in place of `vertical_fov`
  float vertical_fov = 0.5235988f;  ///< radians (30°)
  float half_height = 1;            ///< orthographic: half the image's height, world units
  float aspect = 0;                 ///< the file's own width / height; 0: the image's
  float near = 0.01f, far = 1000;   ///< distances along the view axis; far may be infinite (perspective only)
  std::optional<Lens> lens{};       ///< replaces field of view and aspect; perspective only

  /// The projection for an image of the given aspect (width / height).
  float4x4 clip_from_camera(float picture_aspect) const;
};

/// The default view: three-quarter, from the front right and above, the whole scene in the image.
struct AutoFit {
  float azimuth = 0.5235988f;       ///< radians about +Y from the front (+Z), towards +X
  float elevation = 0.3490659f;     ///< radians above the horizon
  float vertical_fov = 0.5235988f;  ///< radians (30°)
  bool is_orthographic = false;     ///< a parallel projection from the same direction
  float margin = 0.05f;             ///< fraction of the image that stays free on the tightest side
  float3 up{0, 1, 0};               ///< the scene's upward axis
};

/// The camera that shows all of `points` in the given direction, as near as the margin allows.
///
/// The eye moves along the view axis until the tightest point lies on the margin, and sideways so that the free space
/// is the same left and right, above and below. Near and far are put around the points. No point, or a single one, gets
/// a camera 1 unit away.
Camera fit_camera(std::span<const float3> points, float picture_aspect, const AutoFit& fit);

/// The same for the eight corners of a box.
Camera fit_camera(const Box& box, float picture_aspect, const AutoFit& fit);

}  // namespace zoneplate
#pragma GCC visibility pop
