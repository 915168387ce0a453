// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "zoneplate/antialias/post/smaa/searches.h"
#include "zoneplate/antialias/post/smaa/smaa.h"
#include "zoneplate/antialias/post/smaa/tables.h"

namespace zoneplate::antialias {

/// The data of the searches that is common to all pixels.
struct SmaaSearches {
  SearchSteps along_top{top_edge, left_edge}, along_left{left_edge, top_edge};
  std::array<std::int32_t, 16> diagonal_lines;  ///< diagonal_lines_of, by 4 × left code + right code

  SmaaSearches() {
    for (int code = 0; code < 16; ++code)
      diagonal_lines[static_cast<std::size_t>(code)] = diagonal_lines_of(code / 4, code % 4);
  }
};

/// Stores the weights of row y in a cleared row: areas in closed form for a sample at SmaaOptions::exact_offset.
///
/// Requires  `options.exact_offset` has a value.
void compute_exact_weights(const EdgePlane& edges, int y, const SmaaSearches& searches, const SmaaOptions& options,
                           WeightRow& out);

}  // namespace zoneplate::antialias
