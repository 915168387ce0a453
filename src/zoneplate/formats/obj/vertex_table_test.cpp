// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/vertex_table.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "zoneplate/formats/import/colliding_for_test.h"

namespace zoneplate {
namespace {

/// A reference implementation of the table, by a map.
struct Expected {
  std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t, float, float>, std::uint32_t> numbers;
  std::uint32_t number(const ObjCorner& c, float3 made) {
    return numbers.try_emplace({c.position, c.uv, c.normal, made.x, made.y}, static_cast<std::uint32_t>(numbers.size()))
        .first->second;
  }
};

TEST(ObjVertexTable, NumbersCornersInTheOrderOfTheirFirstUse) {
  ObjVertexTable table(10);
  Expected expected;
  for (std::uint32_t i = 0; i < 30000; ++i) {
    const auto index = [&](std::uint32_t k) { return static_cast<std::int32_t>(hash(i, k) % 20) - 1; };
    const ObjCorner corner{index(0), index(1), index(2)};
    const float3 made = i % 3 == 0 ? float3{static_cast<float>(i % 2), 1, 0} : float3{};
    ASSERT_EQ(table.number(corner, made), expected.number(corner, made)) << i;
  }
  EXPECT_FALSE(table.is_ordered());
}

/// Without the ordered map, walking the chains would take 10^9 steps or more.
TEST(ObjVertexTable, CornersThatCollideKeepTheirNumbers) {
  ObjVertexTable table(10);
  Expected expected;
  // These collide in the first hash; after that, the table switches to the hash that scatters.
  for (std::int32_t i = 1; i < 40; ++i) {
    const ObjCorner corner{3 * i, -i, 0};
    ASSERT_EQ(table.number(corner), expected.number(corner, {}));
  }
  for (const int round : {0, 1})
    for (std::uint32_t i = 0; i < 60000; ++i) {
      const std::uint32_t uv = i, normal = i % 7;
      const ObjCorner corner{static_cast<std::int32_t>(colliding_word(0, uv, normal, 0)), static_cast<std::int32_t>(uv),
                             static_cast<std::int32_t>(normal)};
      ASSERT_EQ(table.number(corner), expected.number(corner, {})) << round << " " << i;
    }
  EXPECT_TRUE(table.is_ordered());
  EXPECT_EQ(table.corners().size(), 60039u);
}

}  // namespace
}  // namespace zoneplate
