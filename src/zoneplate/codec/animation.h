#pragma once

#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// Pictures to be shown one after the other, each as long as every other.
///
/// Shape     all frames have the size of the first; there is at least one.
struct Animation {
  std::vector<Rgba8Image> frames;
  int seconds = 1, per = 10;  ///< a frame stays for seconds / per; both in [1, 65535]
  int loops = 0;              ///< how often the whole is shown, at most 65535; 0: without end
  bool has_alpha = false;     ///< false: alpha is not written
};

}  // namespace zoneplate
