// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"

namespace zoneplate {

struct FlipKernels : PerIsa<FlipKernels> {
  /// to[i] = the sum over k of taps[k] × from[k × step + i], for i in [0, n); sums are in the order of the taps, and
  /// elements are independent.
  void (*weighted_sums)(const double* from, std::size_t step, const double* taps, std::size_t count, double* to,
                        std::size_t n);
};

}  // namespace zoneplate
