// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/coverage/centroid.h"

#include <bit>

namespace zoneplate {

CentroidTable::CentroidTable(const SamplePattern& samples, Centroid rule) {
  const bool is_mean = rule == Centroid::Mean || rule == Centroid::MeanOfAll;
  int x = 0, y = 0;
  for (const SamplePosition s : samples) {
    first.push_back(summand(rule == Centroid::Centre ? SamplePosition{} : s));
    more.push_back(is_mean ? summand(s) : 0);
    x += s.x, y += s.y;
  }
  if (rule == Centroid::MeanOfAll) whole = mean_position(x, y, static_cast<int>(samples.size()));
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
