// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "zoneplate/ray/bvh.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

class TextureSet;

/// Computes the planes of a frame that follow from its ids and the vertices: world positions, and the motion of the
/// surface points on the screen since the last moment and to the next one.
///
/// The surface point of a pixel lies at `frame.data_position`, as all of its data do; where the primitive does not
/// reach that position because coverage and positions are rounded, it is the nearest point of the primitive's outline.
/// Where the coordinates of the base colour's texture move over a surface, the point moves with the texture, in the
/// plane of its triangle. Instances of two moments correspond by object and part (scene/counterparts.h), and their
/// vertices by index. An instance or vertex without a counterpart has no motion, nor has a point that is not in front
/// of the other moment's camera.
///
/// Units     position: metres, world. motion: output pixels, x right, y down, the point's position now minus its
///           position at the last moment; flow: its next position minus the one now. Both are without jitter, and 0 in
///           empty pixels.
/// Requires  frame.instance, frame.primitive_id and frame.data_position; the frame was rendered from `now`.
/// Exact     computed in double and rounded once; the same bits for any number of threads.
void add_surface_points(const Moment& now, const Planes& planes, const RenderOptions& options, Frame& frame);

/// The shadow casters of the last moment, which decide what its camera saw. Their tree lasts as long as the scene.
class LastVisibility {
 public:
  /// Makes Frame::was_visible from Frame::last_position. A point of an instance that the last moment lacks was not
  /// seen.
  ///
  /// Requires  `textures` are those of the scenes of both moments; the frame was rendered from `now`.
  void find(const Moment& now, const TextureSet& textures, const RenderOptions& options, Frame& frame);

 private:
  std::shared_ptr<const Scene> scene_;
  std::optional<Bvh> bvh_;
};

}  // namespace zoneplate
