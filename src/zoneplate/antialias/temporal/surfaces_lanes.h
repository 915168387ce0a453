// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/antialias/temporal/resolve.h"
#include "zoneplate/math/for_row.h"

/// The surfaces of a frame's samples, over a lane type of math/lanes.h.
namespace zoneplate::stages {

using antialias::SurfaceRow;

/// The first `count` numbers of each lane's group; a vector of groups of fewer than four numbers also reads those after
/// it.
template <class F, int count>
[[gnu::always_inline]] inline void load_groups(const float* p, F (&out)[4]) {
  static_assert(count == 2 || count == 3);
  if constexpr (F::lanes == 1)
    for (int k = 0; k < count; ++k) out[k] = F::load(p + k);
  else
    F::load_quads([=](int lane) { return p + count * lane; }, out);
}

template <class Full, class One>
[[gnu::flatten]] void take_surfaces(const SurfaceRow& row, std::size_t n) {
  const auto take = [&]<class F>(std::size_t i) {
    // Frame::no_id has the bits of -1; other ids are less than 2^31.
    F::from(F::Int::load(reinterpret_cast<const std::int32_t*>(row.ids) + i)).store(row.surface + i);
    if (row.motion) {
      F motion[4];
      load_groups<F, 2>(row.motion + 2 * i, motion);
      motion[0].store(row.motion_x + i), motion[1].store(row.motion_y + i);
    }
    if (row.last_position) {
      F point[4];
      load_groups<F, 3>(row.last_position + 3 * i, point);
      const auto part = [&](int k) { return (point[k] - F(row.last_eye[k])) * F(row.last_forward[k]); };
      (part(0) + part(1) + part(2)).store(row.last_depth + i);
    }
  };
  // A vector with the last pixel would read beyond the planes.
  constexpr std::size_t lanes = Full::lanes;
  const std::size_t whole = n == 0 ? 0 : lanes == 1 ? n : (n - 1) / lanes * lanes;
  for (std::size_t i = 0; i < whole; i += lanes) take.template operator()<Full>(i);
  if constexpr (lanes > 1)
    for (std::size_t i = whole; i < n; ++i) take.template operator()<One>(i);
}

}  // namespace zoneplate::stages
