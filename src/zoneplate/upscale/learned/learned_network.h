// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/network/network.h"

namespace zoneplate::upscale {

/// The network of `learned`: what it reads of each frame pixel, and what it says.
struct LearnedNetwork {
  static constexpr int features = 40;
  static constexpr int corrections = 14;  ///< for each of four output pixels
  static constexpr network::NetworkForm form{features, 4 * corrections};
  /// For the two output pixels above and below a sample: the outputs from `first` on, `per_pixel` of them, in which
  /// those of the two begin at `begins`.
  static constexpr int per_pixel = 32, first[2] = {0, 4 * corrections - per_pixel}, begins[2] = {0, 4};
  static_assert(first[1] + begins[1] == 2 * corrections);
  /// The number of the history's samples at which corrections of weights change half as much as without history.
  static constexpr float count_at_rest = 4;

  /// The one that the program contains.
  static const network::Network& trained();
};

}  // namespace zoneplate::upscale
