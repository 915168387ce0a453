// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/post/learned_smaa/still_network.h"
#include "zoneplate/antialias/post/smaa/smaa.h"

namespace zoneplate::antialias {

/// How many pixels away the images of `learned-smaa` depend on theirs.
inline int learned_smaa_radius() { return smaa_radius(SmaaOptions{}) + StillCorrections::radius; }

/// The image after `learned-smaa`; it is a part of an image from its pixel (x, y) on.
Rgba8Image apply_learned_smaa(const Rgba8Image& image, int x = 0, int y = 0);

}  // namespace zoneplate::antialias
