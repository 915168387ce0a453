// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/cli/process/item_process.h"
#include "zoneplate/cli/render/picture.h"

namespace zoneplate::cli {

/// Renders the frames of the arguments and sends them: numbered files, a film, or the frames of a film that the
/// receiver encodes (film.h).
///
/// Frame i is the animation at i / rate seconds. On a turntable of n frames the camera has rotated by i / n of a turn
/// about the centre of the scene. The camera of a whole-scene view contains the whole animation, independently of the
/// rendered frames, and does not move. Exposure, tone curve and point size that the scene decides are those of frame 0.
///
/// Errors    ErrorKind::Usage: no frames, a name without a placeholder for the number; ErrorKind::Input for an
///           animation with too many frames.
void render_sequence(RenderArgs args, std::unique_ptr<Resolver> method, ItemSender& out, Summary& summary);

/// The time at which the animations end that a choice plays, in seconds; 0 if it plays none.
double end_of_animation(const SceneChoice& choice, const Scene& scene);

/// A warning for a time (--animation-time) after that end; empty for one before it.
std::string lateness(const RenderArgs& args, double end);

/// True for the name of a film: .apng and .webp, or is_encoded_by_ffmpeg.
bool is_film(const std::string& output);

}  // namespace zoneplate::cli
