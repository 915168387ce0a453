// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "zoneplate/base/parallel.h"

namespace zoneplate::metrics {

/// Calls `body(y)` for rows 0 to height - 1, in parallel.
template <class Body>
void for_rows(int height, const Body& body) {
  parallel_for(static_cast<std::size_t>(height), [&](std::size_t y) { body(static_cast<int>(y)); });
}

/// The sum of `row_value(y)` over rows 0 to height - 1.
///
/// Exact     rows are evaluated in parallel and added in order: the same bits for any number of threads.
template <class RowValue>
double sum_rows(int height, const RowValue& row_value) {
  std::vector<double> rows(static_cast<std::size_t>(height));
  for_rows(height, [&](int y) { rows[static_cast<std::size_t>(y)] = row_value(y); });
  double sum = 0;
  for (const double row : rows) sum += row;
  return sum;
}

}  // namespace zoneplate::metrics
