// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/evaluate.h"

#include <cmath>

#include "zoneplate/math/lanes.h"
#include "zoneplate/sdf/evaluate_lanes.h"

namespace zoneplate {

template <>
const sdf::CoverageKernels PerIsa<sdf::CoverageKernels>::scalar = sdf::stages::coverage_kernels<scalar::Float>();

namespace sdf {

void select_pieces(const Program& program, const Instruction& region, float low_x, float high_x, float low_y,
                   float high_y, PieceSelection& selection) {
  selection.near.clear(), selection.beside.clear();
  selection.winding = 0;
  const Piece* const pieces = program.pieces().data();
  // No point is farther from the outline than from the nearest start of a part.
  const float middle_x = (low_x + high_x) * 0.5f, middle_y = (low_y + high_y) * 0.5f;
  float square = 1e30f;
  for (std::int32_t i = region.first; i < region.end; ++i) {
    const float x = pieces[i].start_x - middle_x, y = pieces[i].start_y - middle_y;
    square = std::min(square, x * x + y * y);
  }
  const float half_x = high_x - middle_x, half_y = high_y - middle_y;
  const float reach = (std::sqrt(square) + std::sqrt(half_x * half_x + half_y * half_y)) * 1.0001f + 1e-6f;
  const float reach_square = reach * reach;
  for (std::int32_t i = region.first; i < region.end; ++i) {
    const Piece& p = pieces[i];
    const float x = std::max({p.low_x - high_x, low_x - p.high_x, 0.0f});
    const float y = std::max({p.low_y - high_y, low_y - p.high_y, 0.0f});
    if (x * x + y * y <= reach_square) {
      selection.near.push_back(i);
    } else if (p.direction != 0 && p.high_x > low_x && p.low_y <= high_y && p.high_y > low_y) {
      if (p.low_x > high_x && p.low_y <= low_y && p.high_y > high_y)
        selection.winding += p.direction;
      else
        selection.beside.push_back(i);
    }
  }
}

}  // namespace sdf
}  // namespace zoneplate
