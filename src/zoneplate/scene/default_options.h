// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The antialiasing of images whose user names none: eight samples a pixel, and the alpha test of masked surfaces at
/// each of them. Elsewhere the test costs nothing; in `foliage` it doubles the time.
inline constexpr const char* default_method = "msaa:n=8,alpha=samples";

/// The maximum anisotropy of texture filtering for models of files whose user names none. It keeps floors and sides
/// sharp that are seen at a grazing angle, and costs time at these alone.
/// Source    model-viewer and Babylon.js, which have the same default.
inline constexpr int default_anisotropy = 4;

/// The size of points whose user names none, in pixels: squares of this size for all points of the scene would cover a
/// sixteenth of the image. Few points are visible, and dense clouds keep their detail.
///
/// Edges     at least 1, and at most a hundredth of the image's height
float default_point_size(const Scene& scene, int width, int height);
/// The same for a number of points.
float default_point_size(double points, int width, int height);
/// The points of all instances.
double points_of(const Scene& scene);

}  // namespace zoneplate
