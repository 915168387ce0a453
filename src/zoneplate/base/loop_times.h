// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

namespace zoneplate {

/// A loop of `parallel_for`: the time of each item, in milliseconds, in the order in which threads take them.
using LoopTimes = std::vector<double>;

/// The times of some work on one thread, in milliseconds.
struct WorkTimes {
  std::vector<LoopTimes> loops;  ///< outermost loops, in order
  double total = 0;

  /// The time outside of loops.
  double serial() const;
};

/// Runs `body` on one thread and measures the items of its loops.
WorkTimes time_loops(const std::function<void()>& body);

/// The time of a loop on `threads` threads, if each free thread takes the next item and no item takes longer because of
/// the others: the schedule of `parallel_for` without the sharing of caches and memory.
double scheduled_ms(const LoopTimes& items, int threads);

}  // namespace zoneplate
