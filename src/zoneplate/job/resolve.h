// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/job/job.h"
#include "zoneplate/render/prepared_scene.h"

namespace zoneplate {

/// Decides what a job leaves to the scene: the view, the upward axis, the point size, the anisotropy, the background
/// and, from that of the scene's light, the tone curve. No other place knows a default that depends on the scene.
///
/// A built-in scene that has a camera is seen by it, in a sequence if it moves; others are seen as a whole.
Job resolve(Job job, const Scene& scene, ToneMapping of_light);

/// Chooses the point size for a number of points where the job has none, as `resolve` does for those of a scene.
void resolve_point_size(double points, Job& job);

/// A scene under the light of a job, and the job with nothing left to the scene.
struct LitStill {
  Job job;
  PreparedScene scene;
  Camera camera;
  std::string warning;  ///< of set_light_dimming
};

/// Resolves a job for a still image of a scene whose materials are those of the job: its lights, its camera, its
/// brightness. `camera` is used in place of the view of the job, if it is not null.
LitStill light_still(Job job, const PreparedScene& scene, bool is_linear, const Camera* camera = nullptr);

/// Whether the lights of a file may be dimmed: options choose neither the lights nor the brightness, and the image is
/// not linear.
bool may_dim_lights(const Job& job, bool is_linear);

/// Sets `job.light_dimming`: where the lights of a file would clip a quarter of the surfaces or more to white, the
/// factor that brings them to the brightness of --exposure auto; 1 for others, and where they may not be dimmed.
/// Returns the warning about it; empty for a factor of 1.
std::string set_light_dimming(Job& job, const PreparedScene& lit, bool is_linear);

/// The exposure of --exposure auto: auto_exposure (image/auto_exposure.h) of an image of at most 256 pixels a side,
/// with one sample per pixel, of the whole view.
float metered_exposure(const PreparedScene& scene, const Camera& camera, const Job& job);

}  // namespace zoneplate
