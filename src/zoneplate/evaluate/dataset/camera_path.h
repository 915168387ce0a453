// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/scene/camera.h"

namespace zoneplate {

/// The perspective camera that shows what an orthographic one shows at `distance` on its axis; others as they are.
Camera as_perspective(const Camera& camera, float distance);

/// A smooth motion of a camera, chosen by a seed: it orbits about a point of the scene, approaches it and recedes, each
/// as a sine of the frame's number; an orthographic one widens and narrows its view. Every fourth path rests, so that
/// the data contain static sequences.
///
/// Exact     a function of the seed and the frame alone: the same bits on every machine.
class CameraPath {
 public:
  CameraPath(std::uint32_t seed, std::uint32_t sequence);

  /// The camera of a frame: `camera` moved along the path about the point at `distance` on its axis.
  Camera at(const Camera& camera, float distance, int frame) const;

  /// A moment of the scene's animation at which the sequence begins, as a part of its duration.
  float start() const { return start_; }

 private:
  float start_, yaw_, pitch_, dolly_;  ///< amplitudes in radians, and a part of the distance
  double yaw_phase_, pitch_phase_, dolly_phase_, rate_;
};

}  // namespace zoneplate
