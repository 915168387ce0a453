#pragma once

#include "zoneplate/render/method.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// Renders a frame as a method asks, and again for as long as a look at the last frame makes it ask again.
///
/// `counts` are of all rounds together. `frame.display` is what `display` says.
Frame render_rounds(const Scene& scene, const Camera& camera, Resolver& resolver, const Request& request,
                    RenderOptions options, const DisplayOptions& display, RenderCounts* counts = nullptr);

/// The picture as it is shown: what the method makes of the frame, tone mapped in between, as 8-bit codes.
///
/// A frame that holds `shown` already is that picture. Where `counts` is given, the times of the three steps are set.
Rgba8Image show(Resolver& resolver, Frame& frame, RenderCounts* counts = nullptr);

/// Both in one; where the method's request is local the picture is made tile by tile.
Rgba8Image render_picture(const Scene& scene, const Camera& camera, Resolver& resolver, RenderOptions options,
                          const DisplayOptions& display, RenderCounts* counts = nullptr);

}  // namespace zoneplate
