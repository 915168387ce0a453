// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/percents.h"

#include <atomic>
#include <memory>
#include <utility>

namespace zoneplate {

std::function<void(double)> percents(double begin, double end, std::function<void(double)> report) {
  auto last = std::make_shared<std::atomic<int>>(static_cast<int>(100 * begin));
  return [begin, end, last, report = std::move(report)](double done) {
    const int now = static_cast<int>(100 * (begin + (end - begin) * done));
    for (int before = *last; before < now;)
      if (last->compare_exchange_weak(before, now)) return report(now / 100.0);
  };
}

}  // namespace zoneplate
