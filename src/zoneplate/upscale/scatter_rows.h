// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "zoneplate/base/parallel.h"

namespace zoneplate::upscale {

/// The rows that the elements of one row are scattered to; without elements, none.
struct RowRange {
  int first = std::numeric_limits<int>::max(), last = -1;
  void add(int row) { first = std::min(first, row), last = std::max(last, row); }
};

/// Scatters rows of a plane into rows of one of the same height, in parallel for blocks of those: calls
/// begin(first, after) for each block of rows [first, after), and then scatter(y, first, after) in order for every row
/// y that reaches it, which writes to this block alone.
template <class Begin, class Scatter>
void scatter_rows(std::span<const RowRange> reached, const Begin& begin, const Scatter& scatter) {
  parallel_ranges(reached.size(), 64, [&](std::size_t from, std::size_t to) {
    const auto first = static_cast<int>(from), after = static_cast<int>(to);
    begin(first, after);
    for (std::size_t y = 0; y < reached.size(); ++y)
      if (reached[y].first < after && reached[y].last >= first) scatter(static_cast<int>(y), first, after);
  });
}

}  // namespace zoneplate::upscale
