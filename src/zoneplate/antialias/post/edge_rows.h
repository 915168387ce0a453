// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "zoneplate/antialias/post/bordered.h"
#include "zoneplate/antialias/post/edge_stencil.h"
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/row_window.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {

/// The borders of a pixel that are edges.
enum : std::uint8_t { left_edge = 1, top_edge = 2 };
using EdgePlane = Bordered<std::uint8_t>;

/// Computes rows with `fill(y, row)` and edges from them with `detect(rows, edges)`, in parallel for blocks of rows.
template <class T, class Fill, class Detect>
void detect_edges(EdgePlane& edges, const Fill& fill, const Detect& detect) {
  constexpr std::size_t rows = 32;
  const int height = edges.height();
  parallel_ranges(static_cast<std::size_t>(height), rows, [&](std::size_t begin, std::size_t end) {
    RowWindow<T> window(edges.width());
    const auto make = [&](int y) {
      fill(std::clamp(y, 0, height - 1), window.begin_row(y));
      window.end_row(y);
    };
    const int first = static_cast<int>(begin), last = static_cast<int>(end);
    for (int y = first - 2; y <= first; ++y) make(y);
    for (int y = first; y < last; ++y) {
      make(y + 1);
      detect({{window.begin_row(y - 2), window.begin_row(y - 1), window.begin_row(y), window.begin_row(y + 1)}},
             edges.at(0, y));
    }
  });
}

}  // namespace zoneplate::antialias
