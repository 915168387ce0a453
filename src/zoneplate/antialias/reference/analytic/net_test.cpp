// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/net.h"

#include <gtest/gtest.h>

#include <array>

namespace zoneplate::antialias {
namespace {

TEST(SampleNet, EverySquareHoldsItsShareOfEveryRoundAndGroup) {
  const SampleNet net;
  for (const SampleNet::Shift shift : {SampleNet::Shift{}, {0x9e3779b9u, 0x12345678u}})
    for (std::size_t round = 0; round < SampleNet::ends.size(); ++round)
      for (int level = 0; level <= SampleNet::deepest; ++level) {
        const std::uint32_t count = 1u << level;
        for (std::uint32_t row = 0; row < count; ++row)
          for (std::uint32_t column = 0; column < count; ++column) {
            std::size_t found = 0;
            std::array<std::size_t, SampleNet::groups> by_group{};
            net.for_square(round, level, column, row, shift, [&](SampleNet::Sample s) {
              EXPECT_EQ(static_cast<std::uint32_t>(s.x * count), column);
              EXPECT_EQ(static_cast<std::uint32_t>(s.y * count), row);
              ++found, ++by_group[s.group];
            });
            ASSERT_EQ(found, net.size(round) / (count * count));
            // At this level only all groups of the first round together are stratified.
            if (level == SampleNet::deepest) continue;
            for (std::size_t g = 0; g < SampleNet::groups; ++g)
              ASSERT_EQ(by_group[g], round > 0 && g == 0 ? 0 : SampleNet::ends[round] / 4 / (count * count));
          }
      }
}

}  // namespace
}  // namespace zoneplate::antialias
