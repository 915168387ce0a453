// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace zoneplate {

/// Calls some.operator()<F>(i) along a row of n values: with F = Full for whole vectors, then with F = One for each
/// remaining value.
template <class Full, class One, class Some>
[[gnu::always_inline]] inline void for_row(std::size_t n, const Some& some) {
  constexpr std::size_t lanes = Full::lanes;
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) some.template operator()<Full>(i);
  if constexpr (lanes > 1)
    for (; i < n; ++i) some.template operator()<One>(i);
}

}  // namespace zoneplate
