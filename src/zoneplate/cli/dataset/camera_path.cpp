// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/dataset/camera_path.h"

#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::cli {
namespace {

struct Pose {
  Camera camera;
  float3 focus;
  float distance;
};

/// The camera as a perspective one, and the point at which its height of view is that of an orthographic one.
Pose pose_of(const Camera& camera, float distance) {
  const float3 eye = xyz(camera.world_from_camera.column[3]), forward = -xyz(camera.world_from_camera.column[2]);
  Pose pose{camera, {}, distance};
  pose.focus = eye + forward * pose.distance;
  if (!camera.is_orthographic) return pose;
  // Of a parallel projection the scene lies anywhere before the camera, so that the eye stays where it is.
  pose.camera.is_orthographic = false;
  pose.camera.vertical_fov = 2 * atan2(camera.half_height, distance);
  return pose;
}

}  // namespace

CameraPath::CameraPath(std::uint32_t seed, std::uint32_t sequence) {
  std::uint32_t dimension = 0;
  const auto next = [&] { return unit_float(hash(seed, sequence, dimension++)); };
  const bool rests = sequence % 4 == 3;
  start_ = next();
  yaw_ = rests ? 0 : 0.02f + 0.1f * next();
  pitch_ = rests ? 0 : 0.01f + 0.05f * next();
  dolly_ = rests ? 0 : 0.1f * next();
  yaw_phase_ = static_cast<double>(next()), pitch_phase_ = static_cast<double>(next());
  dolly_phase_ = static_cast<double>(next()), rate_ = (0.5 + static_cast<double>(next())) / 100;  // turns per frame
}

Camera CameraPath::at(const Camera& camera, float distance, int frame) const {
  Pose pose = pose_of(camera, distance);
  if (yaw_ == 0) return pose.camera;
  const auto wave = [&](float amplitude, double phase) {
    return amplitude * static_cast<float>(sin_pi(2 * (phase + rate_ * frame)));
  };
  float4x4& world_from_camera = pose.camera.world_from_camera;
  const float3 up = xyz(world_from_camera.column[1]), right = xyz(world_from_camera.column[0]);
  const float3 away = xyz(world_from_camera.column[2]) * (pose.distance * wave(dolly_, dolly_phase_));
  world_from_camera = translation(pose.focus) * rotation(up, wave(yaw_, yaw_phase_)) *
                      rotation(right, wave(pitch_, pitch_phase_)) * translation(away - pose.focus) * world_from_camera;
  return pose.camera;
}

}  // namespace zoneplate::cli
