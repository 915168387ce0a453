// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/metrics/flip/weighted_sums.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

void weighted_sums(const double* from, std::size_t step, const double* taps, std::size_t count, double* to,
                   std::size_t n) {
  const hn::CappedTag<double, 4> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes) {
    auto a = hn::Zero(d), b = a, c = a, e = a;
    for (std::size_t k = 0; k < count; ++k) {
      const auto tap = hn::Set(d, taps[k]);
      const double* at = from + k * step + i;
      a = hn::Add(a, hn::Mul(tap, hn::LoadU(d, at)));
      b = hn::Add(b, hn::Mul(tap, hn::LoadU(d, at + lanes)));
      c = hn::Add(c, hn::Mul(tap, hn::LoadU(d, at + 2 * lanes)));
      e = hn::Add(e, hn::Mul(tap, hn::LoadU(d, at + 3 * lanes)));
    }
    hn::StoreU(a, d, to + i), hn::StoreU(b, d, to + i + lanes);
    hn::StoreU(c, d, to + i + 2 * lanes), hn::StoreU(e, d, to + i + 3 * lanes);
  }
  for (; i < n; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += taps[k] * from[k * step + i];
    to[i] = sum;
  }
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const FlipKernels PerIsa<FlipKernels>::HWY_NAMESPACE = {.weighted_sums = HWY_NAMESPACE::weighted_sums};
}  // namespace zoneplate
