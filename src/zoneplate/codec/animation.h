// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// The frames of an animation, all with the same duration.
///
/// Shape     all frames have the size of the first; there is at least one.
struct Animation {
  std::vector<Rgba8Image> frames;
  int seconds = 1, per = 10;  ///< a frame lasts seconds / per; both in [1, 65535]
  int loops = 0;              ///< number of repetitions, at most 65535; 0: endless
  bool has_alpha = false;     ///< false: alpha is not written
};

}  // namespace zoneplate
