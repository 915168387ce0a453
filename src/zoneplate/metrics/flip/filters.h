// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace zoneplate::metrics {

/// Weights of a one-dimensional filter at positions -radius to radius.
using Taps = std::vector<double>;

/// The filters of FLIP for one viewing distance; each is separable in x and y.
struct FlipFilters {
  int color_radius = 0;
  Taps lightness, red_green;                   ///< contrast sensitivity; sum 1
  Taps blue_yellow_narrow, blue_yellow_broad;  ///< their two products together sum to 1
  int feature_radius = 0;
  /// A Gaussian and its first and second derivative; positive and negative parts sum to 1 and -1.
  Taps smooth, slope, bend;

  int radius() const { return color_radius > feature_radius ? color_radius : feature_radius; }
};

FlipFilters make_flip_filters(double pixels_per_degree);

}  // namespace zoneplate::metrics
