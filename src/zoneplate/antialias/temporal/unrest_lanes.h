// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/antialias/temporal/resolve.h"
#include "zoneplate/math/for_row.h"

/// Where history may contain colours that have moved elsewhere, over a lane type of math/lanes.h.
namespace zoneplate::stages {

using antialias::UnrestRow;

template <class F>
[[gnu::always_inline]] inline typename F::Bool differs(F ax, F ay, F bx, F by, float limit) {
  return (abs(ax - bx) > F(limit)) | (abs(ay - by) > F(limit));
}

/// The numbers of the last frame's objects at 3 × 3 pixels around a source. Where neighbouring pixels have neighbouring
/// sources, as most have, they are loaded without gathering.
template <class F>
class PastObjects {
 public:
  using Int = typename F::Int;
  [[gnu::always_inline]] PastObjects(const UnrestRow& row, F x, F y, std::ptrdiff_t i) : row_(row) {
    const F column = F::load(row.column + i);
    x_ = truncate(min(max(x, F(-2.0f)), F(static_cast<float>(row.width + 1))));
    y_ = truncate(min(max(y, F(-2.0f)), F(static_cast<float>(row.height + 1))));
    const Int shift = x_ - truncate(column);
    first_ = i + shift.first();
    is_block_ = shift.is_uniform() && y_.is_uniform() && first_ >= 1 && first_ + F::lanes < row.width &&
                y_.first() >= 1 && y_.first() + 1 < row.height;
  }
  [[gnu::always_inline]] F at(int i, int j) const {
    if (is_block_) return F::load(row_.past_surface + (std::ptrdiff_t{y_.first()} + j) * row_.width + first_ + i);
    const auto within = [](Int v, int size) { return min(max(v, Int(0)), Int(size - 1)); };
    return F::gather(row_.past_surface,
                     within(y_ + Int(j), row_.height) * Int(row_.width) + within(x_ + Int(i), row_.width));
  }

 private:
  const UnrestRow& row_;
  Int x_, y_;
  std::ptrdiff_t first_;
  bool is_block_;
};

template <class Full, class One>
[[gnu::flatten]] void find_unrest(const UnrestRow& row, float* unrest, std::size_t n) {
  constexpr float likeness = 1 / 128.0f;  // pixels; over twenty frames a sixth of a pixel
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    const F half(0.5f), one(1.0f), zero(0.0f);
    const F x = F::load(row.motion[0] + i), y = F::load(row.motion[1] + i), object = F::load(row.surface + i);
    auto moves = differs(x, y, zero, zero, 1 / 2048.0f), is_left = zero > one;
    const PastObjects<F> past(row, floor(F::load(row.column + i) - x + half),
                              floor(F(static_cast<float>(row.y)) - y + half), i);
    for (int k = 0; k < 9; ++k) {
      const int dx = k % 3 - 1, dy = k / 3 - 1;
      const std::ptrdiff_t near = i + dx + dy * row.stride;
      moves = moves | differs(F::load(row.motion[0] + near), F::load(row.motion[1] + near), x, y, likeness);
      const F other = past.at(dx, dy);
      const auto is_other = (other > object) | (object > other);
      if (none(is_other)) continue;
      const auto number = truncate(other + one);
      is_left = is_left | (is_other & differs(F::gather(row.object_motion[0], number),
                                              F::gather(row.object_motion[1], number), x, y, likeness));
    }
    select(is_left, F(2.0f), where(moves, one)).store(unrest + i);
  });
}

}  // namespace zoneplate::stages
