// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/signal/fourier/series.h"

namespace zoneplate {

struct SeriesOptions : SignalOptions {
  std::vector<int> terms = {1, 3, 5, 15};
};

/// Prints the errors of the partial sums of a wave, and plots them and its harmonics if there is an output.
void plot_series(Wave wave, const SeriesOptions& args, Delivery& out);

}  // namespace zoneplate
