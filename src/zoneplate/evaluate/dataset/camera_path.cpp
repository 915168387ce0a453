// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/dataset/camera_path.h"

#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {

Camera as_perspective(const Camera& camera, float distance) {
  Camera out = camera;
  if (!camera.is_orthographic) return out;
  // Of a parallel projection the scene lies anywhere before the camera, so that the eye stays where it is.
  out.is_orthographic = false;
  out.vertical_fov = 2 * atan2(camera.half_height, distance);
  return out;
}

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
  if (yaw_ == 0) return camera;
  Camera out = camera;
  const auto wave = [&](float amplitude, double phase) {
    return amplitude * static_cast<float>(sin_pi(2 * (phase + rate_ * frame)));
  };
  const float dolly = wave(dolly_, dolly_phase_);
  float4x4& world_from_camera = out.world_from_camera;
  const float3 eye = xyz(world_from_camera.column[3]), forward = -xyz(world_from_camera.column[2]);
  const float3 focus = eye + forward * distance;
  const float3 up = xyz(world_from_camera.column[1]), right = xyz(world_from_camera.column[0]);
  const float3 away = xyz(world_from_camera.column[2]) * (distance * (camera.is_orthographic ? 0 : dolly));
  if (camera.is_orthographic) out.half_height = camera.half_height * (1 + dolly);
  world_from_camera = translation(focus) * rotation(up, wave(yaw_, yaw_phase_)) *
                      rotation(right, wave(pitch_, pitch_phase_)) * translation(away - focus) * world_from_camera;
  return out;
}

}  // namespace zoneplate
