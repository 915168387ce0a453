// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "zoneplate/base/deadline.h"

namespace zoneplate {

/// Calls `body(begin, end)` for consecutive ranges that cover [0, count), in order on this thread, for long loops that
/// cannot be parallelized.
///
/// Errors    those of `check_deadline`, which is called before each range.
template <class Body>
void serial_ranges(std::size_t count, const Body& body) {
  constexpr std::size_t grain = std::size_t{1} << 14;
  for (std::size_t begin = 0; begin < count; begin += grain) {
    check_deadline();
    body(begin, std::min(count, begin + grain));
  }
}

}  // namespace zoneplate
