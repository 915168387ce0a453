// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/post/cmaa2/edge_detection.h"
#include "zoneplate/antialias/post/edge_lanes.h"
#include "zoneplate/math/for_row.h"

/// Cmaa2Kernels::edge_row over a lane type of math/lanes.h.
namespace zoneplate::stages {

template <class Full, class One>
[[gnu::flatten]] void cmaa2_edge_row(const float* const (&rows)[4], float threshold, float contrast,
                                     std::uint8_t* edges, std::size_t count) {
  for_row<Full, One>(count, [&]<class F>(std::size_t i) {
    const auto at = [&](int row, int x) { return F::load(rows[row] + static_cast<std::ptrdiff_t>(i) + x); };
    const F m = at(1, 0), e = at(1, 1), s = at(2, 0), se = at(2, 1), n = at(0, 0), ne = at(0, 1);
    const F w = at(1, -1), sw = at(2, -1);
    const F right = abs(m - e), below = abs(m - s);
    const F ends_right = max(max(abs(n - m), below), max(abs(ne - e), abs(e - se)));
    const F ends_below = max(max(abs(w - m), right), max(abs(sw - s), abs(s - se)));
    const F least(threshold), share(contrast);
    store_edges<F>(right - share * ends_right > least, below - share * ends_below > least, edges + i);
  });
}

}  // namespace zoneplate::stages
