// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/corners.h"

namespace zoneplate {

/// Adds a fragment of the triangle of fragment i. It has no footprint and no pixel: its colour must not depend on the
/// fragments of the triangle that are in the batch.
void TriangleCorners::add(const FragmentBatch& fragments, std::size_t i, float b1, float b2) {
  const auto to = static_cast<std::size_t>(corners_.count++);
  const std::size_t leader = fragments.leader(i);
  corners_.triangle[to] = fragments.triangle[leader], corners_.instance[to] = fragments.instance[leader];
  corners_.is_front[to] = fragments.is_front[leader];
  for (std::size_t k = 0; k < 3; ++k) corners_.vertex[k][to] = fragments.vertex[k][leader];
  corners_.x[to] = corners_.y[to] = 0;
  corners_.b[0][to] = b1, corners_.b[1][to] = b2;
  for (std::size_t k = 0; k < 2; ++k) corners_.dbdx[k][to] = corners_.dbdy[k][to] = 0;
}

int TriangleCorners::collect(const FragmentBatch& fragments, int begin) {
  corners_.count = 0, corners_.material = fragments.material;
  int i = begin;
  for (std::size_t previous = 0; i < fragments.count; ++i) {
    const std::size_t leader = fragments.leader(static_cast<std::size_t>(i));
    const bool is_new = i == begin || fragments.triangle[leader] != fragments.triangle[previous];
    if (is_new && corners_.count + per_triangle_ > FragmentBatch::capacity) break;
    first_[i] = is_new ? corners_.count : first_[i - 1];
    previous = leader;
    if (!is_new) continue;
    constexpr float third = 1.0f / 3;
    const auto at = static_cast<std::size_t>(i);
    if (per_triangle_ == 1)
      add(fragments, at, third, third);
    else
      add(fragments, at, 0, 0), add(fragments, at, 1, 0), add(fragments, at, 0, 1);
  }
  // Whole groups are shaded: the last entries repeat the last fragment.
  const int count = corners_.count, last_of = i - 1;
  while (corners_.count < corners_.padded() && corners_.count % FragmentBatch::group != 0)
    add(fragments, static_cast<std::size_t>(last_of), 0, 0);
  corners_.count = count;
  return i;
}

}  // namespace zoneplate
