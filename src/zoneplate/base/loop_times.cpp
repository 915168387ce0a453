// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/loop_times.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace zoneplate {

double WorkTimes::serial() const {
  double ms = total;
  for (const LoopTimes& loop : loops) ms -= std::accumulate(loop.begin(), loop.end(), 0.0);
  return ms;
}

double scheduled_ms(const LoopTimes& items, int threads) {
  std::vector<double> free_at(static_cast<std::size_t>(threads), 0.0);
  for (const double ms : items) *std::min_element(free_at.begin(), free_at.end()) += ms;
  return *std::max_element(free_at.begin(), free_at.end());
}

}  // namespace zoneplate
