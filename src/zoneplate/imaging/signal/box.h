// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/imaging/signal/result.h"

namespace zoneplate {

struct BoxOptions : SignalOptions {
  std::vector<int> widths = {3, 7, 15};
};

/// Prints the first zeros and other frequencies of the boxes, and plots the boxes and their spectra if there is an
/// output.
void plot_boxes(const BoxOptions& args, Delivery& out);

}  // namespace zoneplate
