// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/post/edge_lanes.h"
#include "zoneplate/antialias/post/mlaa/edge_detection.h"
#include "zoneplate/math/for_row.h"

/// MlaaKernels::luma_edges over a lane type of math/lanes.h.
namespace zoneplate::stages {

template <class Full, class One>
[[gnu::flatten]] void mlaa_luma_edges(const EdgeRows<float>& rows, float threshold, std::uint8_t* edges,
                                      std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    const float* here = rows.row[2] + i;
    const F m = F::load(here), least(threshold);
    const auto to = [&](const float* other) { return abs(m - F::load(other)); };
    const F left = to(here - 1), top = to(rows.row[1] + i);
    const F greatest = max(max(left, top), max(to(here + 1), to(rows.row[3] + i)));
    store_edges<F>((left >= least) & (left + left >= greatest), (top >= least) & (top + top >= greatest), edges + i);
  });
}

}  // namespace zoneplate::stages
