#pragma once

#include <cstddef>
#include <vector>

#include "zoneplate/base/parallel.h"

namespace zoneplate::metrics {

/// The sum of `row_value(y)` over rows 0 to height - 1.
///
/// Exact     rows are measured on any thread and added in their order: the same bits for any number of threads.
template <class RowValue>
double sum_rows(int height, const RowValue& row_value) {
  std::vector<double> rows(static_cast<std::size_t>(height));
  parallel_for(rows.size(), [&](std::size_t y) { rows[y] = row_value(static_cast<int>(y)); });
  double sum = 0;
  for (const double row : rows) sum += row;
  return sum;
}

}  // namespace zoneplate::metrics
