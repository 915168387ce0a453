// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/imaging/signal/result.h"

namespace zoneplate {

struct DecimateOptions : SignalOptions {
  double by = 2;
  std::string kernel = "lanczos3", naive_path, filtered_path;
  bool compares_all = false;
};

/// Drops pixels of an image without and with a filter before, writes both, and prints how much is aliased.
void decimate_image(const std::string& input, const DecimateOptions& args, Delivery& out);

}  // namespace zoneplate
