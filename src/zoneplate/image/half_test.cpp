// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/half.h"

#include <gtest/gtest.h>

#include <limits>

namespace zoneplate {
namespace {

TEST(Half, EveryFiniteOneComesBack) {
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    if ((bits & 0x7c00) == 0x7c00) continue;
    const auto half = static_cast<std::uint16_t>(bits);
    EXPECT_EQ(half_bits(half_value(half)), half) << bits;
  }
}

TEST(Half, MiddlesGoToTheEvenOne) {
  for (std::uint32_t bits = 0; bits < 0x7bff; ++bits) {
    // Both half-precision values and their midpoint are exact as floats.
    const auto low = static_cast<std::uint16_t>(bits), high = static_cast<std::uint16_t>(bits + 1);
    const float middle = (half_value(low) + half_value(high)) / 2;
    EXPECT_EQ(half_bits(middle), bits & 1 ? high : low) << bits;
    EXPECT_EQ(half_bits(std::bit_cast<float>(std::bit_cast<std::uint32_t>(middle) - 1)), low) << bits;
    EXPECT_EQ(half_bits(-std::bit_cast<float>(std::bit_cast<std::uint32_t>(middle) + 1)), high | 0x8000) << bits;
  }
}

TEST(Half, NothingBecomesInfinite) {
  EXPECT_EQ(half_value(half_bits(1e9f)), 65504.0f);
  EXPECT_EQ(half_value(half_bits(65519.99f)), 65504.0f);
  EXPECT_EQ(half_value(half_bits(-std::numeric_limits<float>::infinity())), -65504.0f);
  EXPECT_EQ(half_bits(std::numeric_limits<float>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace zoneplate
