// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/cli/render/item_process.h"
#include "zoneplate/cli/render/picture.h"

namespace zoneplate::cli {

/// Renders the frames that the arguments describe and sends them: numbered files, a film, or the frames of a film that
/// the receiver encodes (film.h).
///
/// Frame i shows the animation at i / rate seconds. On a turntable of n frames the camera has gone i / n of a turn
/// about the centre of the scene. The camera of a whole-scene view stands so that it sees the whole animation,
/// whichever frames are rendered, and does not move.
///
/// Errors    ErrorKind::Usage: no frames, a name without a place for the number; ErrorKind::Input for an animation of
///           too many frames.
void render_sequence(RenderArgs args, std::unique_ptr<Resolver> method, ItemSender& out, Summary& summary);

/// True where the name is that of a film: .apng, .gif, .mp4, .webm, and .webp.
bool is_film(const std::string& output);

}  // namespace zoneplate::cli
