// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// The factor with which 95 % of an image's lit surfaces have no channel above 0.8 of the display's white: 0.8 divided
/// by the 95th percentile of the greatest channel, over the pixels that are at least half covered and not black.
///
/// Edges     1 for an image without such pixels; otherwise from 2^-100 to 2^100.
float auto_exposure(const LinearImage& image);

}  // namespace zoneplate
