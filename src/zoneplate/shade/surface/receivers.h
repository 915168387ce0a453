// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/shade/shadow/light_visibility.h"
#include "zoneplate/shade/surface/shading.h"

namespace zoneplate {

struct Scene;

/// The fragments of a batch as receivers of light.
///
/// Positions are interpolated from the vertices in world space, which are those of the shadow casters bit by bit. Where
/// the vertices' normals differ, the surface that they describe bulges out of the triangle: a position is moved to the
/// mean of its projections onto the tangent planes at those vertices that lie above it, so that a smooth surface of few
/// triangles does not shadow itself along their edges.
/// Source    Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II, 2021.
void make_receivers(const Scene& scene, const FragmentBatch& batch, const TriangleVertices& vertices,
                    const Viewpoint& viewpoint, Receivers& out);

}  // namespace zoneplate
