// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/math/mat.h"
#include "zoneplate/render/method.h"
#include "zoneplate/scene/camera.h"

namespace zoneplate::antialias {

/// The motion on the screen of points that rest in the world.
///
/// Exact     computed in double and rounded once. A camera at rest causes no motion.
class CameraMotion {
 public:
  /// The motion in a frame of this many pixels, of cameras whose views have this aspect (width / height): a frame of
  /// fewer pixels than the image shows the same view, though its sides may have another ratio.
  CameraMotion(const Camera& now, const Camera& last, float aspect, int width, int height);
  /// That of the context's cameras in its frame.
  CameraMotion(const FrameContext& context, int width, int height)
      : CameraMotion(context.camera, context.last_camera, aspect_of(context), width, height) {}

  /// Position now minus position in the last frame of the point at a position of the image and a distance along the
  /// view axis, which may be infinite; 0 for a point that was not in front of the last camera.
  ///
  /// Units     pixels, x right, y down.
  float2 at(double x, double y, double distance) const;
  /// The same for n points of the background, at infinity, at x, x + 1, ...
  ///
  /// Exact     within 1e-12 of `at`, before the rounding.
  void of_background(double x, double y, int n, float* motion_x, float* motion_y) const;
  /// The same for points at the given distances.
  void along_row(double x, double y, std::span<const float> distances, float* motion_x, float* motion_y) const;

 private:
  /// Points at x in a row and at a distance d along the view axis of a perspective camera: coordinate k in the last
  /// camera's space is d (slope[k] x + start[k]) + way[k], in pixels for the first two.
  struct Row {
    double slope[3], start[3], way[3];
  };
  Row row_of(double y) const;

  struct Lens {
    double scale_x, scale_y;
    bool is_orthographic;
    bool operator==(const Lens&) const = default;
  };
  static Lens lens_of(const Camera& camera, float aspect);

  double width_, height_;
  Lens now_, last_;
  double turn_[3][4];  ///< last_camera_from_camera, by row
  bool is_at_rest_;
};

}  // namespace zoneplate::antialias
