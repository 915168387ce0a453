#pragma once

#include <span>
#include <vector>

#include "zoneplate/scene/scene.h"
#include "zoneplate/shade/points.h"

namespace zoneplate {

/// The attributes that a material needs; channels follow in this order (3, 3, 4, 2, 2 and 4 of them).
struct Attributes {
  bool position = false, normal = false, tangent = false, uv[2] = {false, false}, color = false;
  int tangent_uv_set = 0;  ///< which coordinates a tangent is made from where a mesh has none
  bool any() const { return position || normal || tangent || uv[0] || uv[1] || color; }
};

/// Reads the attributes of a batch's corners out of the scene's meshes.
///
/// What a mesh lacks is 0, its colour (1, 1, 1, 1), its tangent the direction of growing u over each triangle (zero
/// where the triangle has no area in u, v; w: the sign of that area).
/// Cost      8 points of one triangle are read once.
void fetch_corners(const Scene& scene, const Batch& batch, const Attributes& attributes, Corners& out);

/// Which channel goes where in the points.
Interpolation interpolation(const Attributes& attributes, Points& points);

/// 1 for the points of meshes that have normals, else 0.
void mark_lit(const Scene& scene, const Batch& batch, float* is_lit);

std::vector<Placement> make_placements(std::span<const Instance> instances);

}  // namespace zoneplate
