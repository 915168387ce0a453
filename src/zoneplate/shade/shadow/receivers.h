// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "zoneplate/math/vec.h"
#include "zoneplate/ray/trace.h"
#include "zoneplate/scene/scene.h"
#include "zoneplate/shade/shadow/light_visibility.h"

namespace zoneplate {

/// The viewer: a position, or the direction to an orthographic camera.
struct ReceiversViewer {
  float3 position, towards;
  bool is_orthographic = false;
};

/// The record of vertex k of the triangle whose values entry i of a batch holds: normal and position, in object space.
using ReceiverRecord = std::function<const float*(std::size_t k, std::size_t i)>;

/// The fragments of a batch as receivers of light.
///
/// Positions are interpolated from the vertices in world space, which are those of the shadow casters bit by bit. Where
/// the vertices' normals differ, the surface that they describe bulges out of the triangle: a position is moved to the
/// mean of its projections onto the tangent planes at those vertices that lie above it, so that a smooth surface of few
/// triangles does not shadow itself along their edges.
/// Source    Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II, 2021.
void make_receivers(const Scene& scene, const FragmentBatch& batch, const ReceiverRecord& record,
                    const ReceiversViewer& viewer, bool has_footprint, Receivers& out);

/// Sets entry i of `out` to the point at a pixel's centre, without a footprint, where a ray from the viewer meets a
/// triangle: `corner` are the records of its vertices.
void make_receiver(const Scene& scene, const RayHit& hit, const float* const (&corner)[3],
                   const ReceiversViewer& viewer, PixelPosition pixel, Receivers& out, std::size_t i);

/// Sets the position in the image of entry i, in 1/256 pixel.
void store_image_position(std::int32_t x, std::int32_t y, Receivers& out, std::size_t i);

/// Sets the footprint of fragment i of a triangle with these edges from its first vertex, from the batch's derivatives.
void store_footprint(const FragmentBatch& batch, std::size_t i, float3 edge1, float3 edge2, Receivers& out);

}  // namespace zoneplate
