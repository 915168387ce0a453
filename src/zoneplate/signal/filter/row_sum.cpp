// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/row_sum.h"

namespace zoneplate::scalar {
namespace {

void narrow(const float* const* rows, std::size_t first, const float* weights, std::size_t taps, float* out,
            std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    float sum = weights[0] * rows[0][first + i];
    for (std::size_t t = 1; t < taps; ++t) sum = sum + weights[t] * rows[t][first + i];
    out[i] = sum;
  }
}

void wide(const float* const* rows, std::size_t first, const double* weights, std::size_t taps, float* out,
          std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    double sum = weights[0] * static_cast<double>(rows[0][first + i]);
    for (std::size_t t = 1; t < taps; ++t) sum = sum + weights[t] * static_cast<double>(rows[t][first + i]);
    out[i] = static_cast<float>(sum);
  }
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const RowSumKernels PerIsa<RowSumKernels>::scalar = {.narrow = scalar::narrow, .wide = scalar::wide};

}  // namespace zoneplate
