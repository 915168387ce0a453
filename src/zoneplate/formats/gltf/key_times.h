// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/formats/import/load_options.h"

namespace zoneplate {

/// Times, in seconds, at which the chosen animations may move a node the farthest: those of keys, and of points between
/// the keys of rotations and cubic splines. The most important come first: the keys with the extremes of a channel's
/// components, those of the widest ranges before others, then the others, spread over the animation.
///
/// Edges     at most 1024 times, and none twice; of channels that change nothing of the shape, none.
/// Errors    those of animate (formats/gltf/animation.h).
std::vector<double> key_times(GltfFile& file, const SceneChoice& choice);

}  // namespace zoneplate
