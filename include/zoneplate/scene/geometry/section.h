// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "zoneplate/scene/scene.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// A plane that cuts away what lies beyond it: points p of the file's coordinates with dot(normal, p) > offset.
struct SectionPlane {
  double3 normal{};   ///< of any length but zero
  double offset = 0;  ///< in the unit of the file times the length of the normal
  bool operator==(const SectionPlane&) const = default;
};

/// Cuts a scene's meshes at planes, and closes the solids that are cut by caps, which belong to their objects.
///
/// A cap fills the outlines in the plane around which the surfaces of one object wind, so that a hollow solid stays
/// hollow and solids that overlap become one. It has the base colour of the surface that is cut, or `cap_color`
/// (linear), without textures. Outlines that are not closed, as those of a sheet, get no cap. Surfaces that are cut are
/// drawn on both sides. Points and lines beyond a plane are left out.
/// Exact     the same bits everywhere; surfaces that are closed stay closed up to the rounding of vertices.
/// Edges     several planes leave what lies beyond none of them. Instances without a part that is left vanish.
/// Source    clipping: Sutherland and Hodgman, Reentrant Polygon Clipping, CACM 17(1), 1974; caps by nonzero winding
///           over the trapezoids of a plane sweep: Vatti, A Generic Solution to Polygon Clipping, CACM 35(7), 1992.
void cut_scene(Scene& scene, std::span<const SectionPlane> planes, std::optional<float4> cap_color = {});

}  // namespace zoneplate
#pragma GCC visibility pop
