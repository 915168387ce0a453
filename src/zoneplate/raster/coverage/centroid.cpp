// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/coverage/centroid.h"

#include <bit>

namespace zoneplate {

CentroidTable::CentroidTable(const SamplePattern& samples, Centroid rule) {
  for (const SamplePosition s : samples) {
    first.push_back(summand(rule == Centroid::Centre ? SamplePosition{} : s));
    more.push_back(rule == Centroid::Mean ? summand(s) : 0);
  }
}

SamplePosition CentroidTable::of(std::uint64_t samples, int begin) const {
  int x = 0, y = 0, n = 0;
  const std::vector<std::int32_t>* of_sample = &first;
  for (; samples; samples &= samples - 1, of_sample = &more) {
    const std::int32_t place = (*of_sample)[static_cast<std::size_t>(begin + std::countr_zero(samples))];
    x += place & 4095, y += place >> 12 & 4095, n += place >> 24;
  }
  return mean_position(x, y, n);
}

}  // namespace zoneplate
