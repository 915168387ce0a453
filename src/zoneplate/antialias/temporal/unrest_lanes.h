// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/antialias/temporal/reprojection_lanes.h"
#include "zoneplate/antialias/temporal/resolve.h"
#include "zoneplate/math/for_row.h"

/// Where history may contain colours that have moved elsewhere, over a lane type of math/lanes.h.
namespace zoneplate::stages {

using antialias::UnrestRow;

template <class F>
[[gnu::always_inline]] inline typename F::Bool differs(F ax, F ay, F bx, F by, float limit) {
  return (abs(ax - bx) > F(limit)) | (abs(ay - by) > F(limit));
}

template <class Full, class One>
[[gnu::flatten]] void compute_unrest(const UnrestRow& row, float* unrest, std::size_t n) {
  constexpr float likeness = 1 / 128.0f;  // pixels; over twenty frames a sixth of a pixel
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    const F half(0.5f), one(1.0f), zero(0.0f);
    const F x = F::load(row.motion[0] + i), y = F::load(row.motion[1] + i), object = F::load(row.surface + i);
    auto moves = differs(x, y, zero, zero, 1 / 2048.0f), is_left = zero > one;
    const F column = F::load(row.column + i), limit(65536.0f);
    const auto bounded = [&](F v) { return min(max(v, -limit), limit); };
    const PastPixels<F> past(bounded(floor(column - x + half)), bounded(floor(F(static_cast<float>(row.y)) - y + half)),
                             row.width, row.height, column, i, 1);
    for (const PixelOffset o : around_square) {
      if (all(moves)) break;
      const std::ptrdiff_t near = i + o.x + o.y * row.stride;
      moves = moves | differs(F::load(row.motion[0] + near), F::load(row.motion[1] + near), x, y, likeness);
    }
    auto is_alone = past.value(row.past_surface, 0, 0) == object;
    for (const PixelOffset o : around_square) is_alone = is_alone & (past.value(row.past_surface, o.x, o.y) == object);
    for (int k = 0; k < 9 && !all(is_alone); ++k) {
      const F other = past.value(row.past_surface, k % 3 - 1, k / 3 - 1);
      const auto is_other = (other > object) | (object > other);
      if (none(is_other)) continue;
      const auto number = truncate(other + one);
      is_left = is_left | (is_other & differs(F::gather(row.object_motion[0], number),
                                              F::gather(row.object_motion[1], number), x, y, likeness));
      if (all(is_left | is_alone)) break;
    }
    select(is_left, F(2.0f), where(moves, one)).store(unrest + i);
  });
}

}  // namespace zoneplate::stages
