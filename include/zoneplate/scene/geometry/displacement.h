// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/scene/scene.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// How finely `displace_surfaces` refines meshes.
struct DisplacementOptions {
  float tolerance = 0.001f;  ///< greatest distance between a mesh and its height map, relative to the longest side of
                             ///< the mesh's bounds
  std::size_t max_triangles = 4'000'000;  ///< of a mesh; where it is reached, the mesh stays coarser, with a warning
};

/// Turns height textures into geometry: every triangle mesh whose material has a height texture is refined where the
/// heights have detail, and its vertices move along their normals by Material::height_scale times the height, in units
/// of object space. The materials then have no height texture.
///
/// In contrast to bump mapping, the outline of a displaced surface changes, and the surface hides and shadows itself.
/// A closed mesh stays closed, whatever its seams; vertex normals are made anew.
/// Requires  a scene that meets the requirements of Scene, whose images are not freed.
/// Exact     the same bits for any number of threads.
/// Errors    those of base/deadline.h.
/// Source    Cook, Shade Trees, SIGGRAPH 1984.
void displace_surfaces(Scene& scene, const DisplacementOptions& options = {});

}  // namespace zoneplate
#pragma GCC visibility pop
