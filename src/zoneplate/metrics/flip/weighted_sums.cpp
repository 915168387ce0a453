// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/flip/weighted_sums.h"

namespace zoneplate {
namespace scalar {
namespace {

void weighted_sums(const double* from, std::size_t step, const double* taps, std::size_t count, double* to,
                   std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += taps[k] * from[k * step + i];
    to[i] = sum;
  }
}

}  // namespace

}  // namespace scalar

template <>
const FlipKernels PerIsa<FlipKernels>::scalar = {.weighted_sums = scalar::weighted_sums};

}  // namespace zoneplate
