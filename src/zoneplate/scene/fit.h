// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The camera that contains a whole scene in the given direction, as close as the margin allows.
///
/// It is `fit_camera` of the farthest vertices on each side, for the slopes of the field of view and fractions of them.
///
/// Exact     the tightest side touches the margin, as for all vertices; the other one is centred within 2% of the
///           image.
Camera fit_camera(const Scene& scene, float picture_aspect, const AutoFit& fit);

/// The directions in which the farthest vertices decide `fit_camera` of a scene with these bounds.
std::vector<float3> fit_directions(const Box& bounds, float picture_aspect, const AutoFit& fit);

/// Whether a triangle with these corners in the world, of an instance with this transform, shows a camera its front.
bool faces(const Camera& camera, const float4x4& world_from_object, const std::array<float3, 3>& corner);

/// Whether a camera sees nothing but back faces of single-sided triangles, which are not drawn.
bool sees_backs_alone(const Scene& scene, const Camera& camera);

/// Distances along a camera's view axis, from its eye; negative behind it.
struct AxisRange {
  float nearest = 0, farthest = 0;
};

/// The distances between which the used vertices of a scene lie; nothing without any.
std::optional<AxisRange> range_along_view(const Scene& scene, const Camera& camera);

}  // namespace zoneplate
