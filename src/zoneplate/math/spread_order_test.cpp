// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/spread_order.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace zoneplate {
namespace {

using Indices = std::vector<std::size_t>;

TEST(SpreadOrder, HalvesTheGaps) {
  EXPECT_EQ(spread_order(8, 8), (Indices{0, 4, 2, 6, 1, 5, 3, 7}));
  EXPECT_EQ(spread_order(1000, 4), (Indices{0, 500, 250, 750}));
  EXPECT_EQ(spread_order(0, 4), Indices{});
  EXPECT_EQ(spread_order(1, 4), Indices{0});
}

TEST(SpreadOrder, HasEachIndexOnce) {
  for (const std::size_t n : {2u, 3u, 5u, 12u, 100u, 255u, 257u}) {
    Indices all = spread_order(n, n);
    std::ranges::sort(all);
    ASSERT_EQ(all.size(), n);
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(all[i], i);
    Indices some = spread_order(n, n / 2 + 1);
    ASSERT_EQ(some.size(), n / 2 + 1);
    std::ranges::sort(some);
    EXPECT_EQ(std::ranges::adjacent_find(some), some.end());
    EXPECT_LT(some.back(), n);
  }
}

}  // namespace
}  // namespace zoneplate
