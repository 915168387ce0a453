// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/summary.h"

#include <algorithm>

namespace zoneplate {

double Summary::total_ms() const {
  const auto total = std::ranges::find(times, "total", &std::pair<std::string, double>::first);
  return total == times.end() ? 0 : total->second;
}

}  // namespace zoneplate
