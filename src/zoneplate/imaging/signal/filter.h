// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/signal/border.h"
#include "zoneplate/signal/fourier/frequency_filter.h"

namespace zoneplate {

struct FrequencyFilterOptions : SignalOptions {
  FrequencyFilter filter;
  std::string shape = "ideal";
  Border border = Border::Reflect;
  bool is_side_by_side = false;
};

/// Removes frequencies of an image, and prints how much of its variance remains.
void filter_frequencies(const std::string& input, const FrequencyFilterOptions& args, Delivery& out);

}  // namespace zoneplate
