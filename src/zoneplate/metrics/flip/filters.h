// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace zoneplate::metrics {

/// Weights of a one-dimensional filter at -radius .. radius.
using Taps = std::vector<double>;

/// The filters of FLIP for one viewing distance; each is a product of one in x and one in y.
struct FlipFilters {
  int color_radius = 0;
  Taps lightness, red_green;                   ///< contrast sensitivity; sum 1
  Taps blue_yellow_narrow, blue_yellow_broad;  ///< their two products together sum to 1
  int feature_radius = 0;
  Taps smooth, slope, bend;  ///< a Gaussian and its first and second derivative, positive and negative part of sum 1

  int reach() const { return color_radius > feature_radius ? color_radius : feature_radius; }
};

FlipFilters make_flip_filters(double pixels_per_degree);

}  // namespace zoneplate::metrics
