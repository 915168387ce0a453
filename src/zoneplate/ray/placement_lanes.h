// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>

#include "zoneplate/ray/bvh.h"

/// Nodes and leaves in object space, placed in the world: `F` for the children of a node, `G` for the triangles of a
/// leaf.
namespace zoneplate::stages {

/// The boxes of a node's children in the world, which contain each vertex as transform_point rounds it.
///
/// Both sums are rounded by less than 2^-21 of the sum of their terms' magnitudes.
/// Source    Arvo, Transforming Axis-Aligned Bounding Boxes, Graphics Gems, 1990.
template <class F>
[[gnu::always_inline]] inline void place(const BvhNode& from, const BvhPlacement& at, BvhNode& to) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const F zero(0.0f);
  for (int i = 0; i < BvhNode::width; i += F::lanes) {
    F low[3], high[3];
    for (int a = 0; a < 3; ++a) low[a] = F::load(from.bound[0][a] + i), high[a] = F::load(from.bound[1][a] + i);
    const auto is_used = high[0] >= low[0];
    for (int r = 0; r < 3; ++r) {
      const float* const row = at.world_from_object[r];
      F first(row[3]), last(row[3]), margin = abs(first);
      for (int a = 0; a < 3; ++a) {
        const F m(row[a]);
        const auto is_reversed = m < zero;
        first = first + m * select(is_reversed, high[a], low[a]);
        last = last + m * select(is_reversed, low[a], high[a]);
        margin = margin + abs(m) * max(abs(low[a]), abs(high[a]));
      }
      margin = margin * F(0x1p-20f);
      select(is_used, first - margin, F(infinity)).store(to.bound[0][r] + i);
      select(is_used, last + margin, F(-infinity)).store(to.bound[1][r] + i);
    }
  }
  std::copy(std::begin(from.child), std::end(from.child), to.child);
}

/// The triangles of a leaf in the world, with the bits that transform_point gives their vertices.
template <class G>
[[gnu::always_inline]] inline void place(const BvhLeaf& from, const BvhPlacement& at, BvhLeaf& to) {
  for (int i = 0; i < BvhLeaf::width; i += G::lanes)
    for (int k = 0; k < 3; ++k) {
      const G x = G::load(from.vertex[k][0] + i), y = G::load(from.vertex[k][1] + i),
              z = G::load(from.vertex[k][2] + i);
      for (int r = 0; r < 3; ++r) {
        const float* const row = at.world_from_object[r];
        (G(row[0]) * x + G(row[1]) * y + G(row[2]) * z + G(row[3])).store(to.vertex[k][r] + i);
      }
    }
  std::fill(std::begin(to.instance), std::end(to.instance), at.instance);
  std::copy(std::begin(from.primitive), std::end(from.primitive), to.primitive);
  to.translucent = at.translucent;
}

}  // namespace zoneplate::stages
