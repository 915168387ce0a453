#pragma once

#include "zoneplate/cli/render_picture.h"

namespace zoneplate::cli {

/// Renders the frames that the arguments ask for, into numbered files or one film; true if all were made.
///
/// Frame i shows the animation at i / rate seconds. On a turntable of n frames the camera has gone i / n of a turn
/// about the centre of the scene. The camera of a whole-scene view stands so that it sees the whole animation,
/// whichever frames are asked for, and stays there. Errors    Trouble::Usage: no frames, a name without a place for the
/// number; Trouble::Failed where ffmpeg is missing.
void render_sequence(RenderArgs args, Resolver& resolver, Summary& summary);

/// True where the name is that of a film: .apng, .gif, .mp4, .webm, and .webp.
bool is_film(const std::string& output);

}  // namespace zoneplate::cli
