#pragma once

#include "zoneplate/render/frame.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// Gives a frame what follows from its ids and where the vertices are: world positions, and how far the surface points
/// have moved on the screen since the last moment and will move to the next.
///
/// A pixel's surface point lies at `frame.place`, where all its data are taken; where its primitive does not reach that
/// by the rounding of coverage or of the place, at the nearest point of its outline.
/// Instances and vertices of two moments belong together by their numbers; one that has no partner stands still, and so
/// does a point that is not in front of the other moment's camera.
///
/// Units     position: metres, world. motion: output pixels, x right, y down, where the point is now minus where it was
///           at the last moment; flow: where it will be minus where it is. No jitter is in either. 0 where nothing is.
/// Requires  frame.instance, frame.primitive_id and frame.place; `now` is what the frame was drawn from.
/// Exact     computed in double and rounded once; the same bits for any number of threads.
void add_surface_points(const Moment& now, const Planes& planes, const RenderOptions& options, Frame& frame);

}  // namespace zoneplate
