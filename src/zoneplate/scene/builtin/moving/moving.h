// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {

/// Parts of the scenes that move. Their only parameter is the time; sequences of the command set it for each frame.
inline constexpr Param moment_params[] = {
    {.name = "time", .meaning = "moment of the motion, in seconds", .value = 0, .low = 0, .high = 10, .decimals = 6}};
inline constexpr float motion_seconds = 2;

/// The moment of a scene with `moment_params`, in seconds.
inline float moment_of(std::span<const std::int64_t> values) { return static_cast<float>(values[0]) / 1e6f; }

/// The side of a pixel of an image 480 pixels high, seen by flat_camera(1).
inline constexpr float pixel_side = 2.0f / 480;

/// Adds the camera of a scene that moves, and the length of its motion.
inline void add_motion(Scene& scene, Camera camera) {
  scene.cameras.assign(1, std::move(camera));
  scene.animations.assign(1, {"motion", 0, motion_seconds});
}

/// A wall of coloured squares of `side`, which fills the image of flat_camera(1), at a depth.
Mesh make_squares(float side, float z);

}  // namespace zoneplate
