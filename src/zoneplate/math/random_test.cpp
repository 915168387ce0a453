// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/random.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>
#include <vector>

namespace zoneplate {
namespace {

TEST(Random, EveryKeyWordCounts) {
  std::set<std::uint32_t> words;
  for (std::uint32_t i = 0; i < 16 * 16 * 16 * 16; ++i) {
    words.insert(hash(i & 15, i >> 4 & 15, i >> 8 & 15, i >> 12 & 15));
  }
  // Among 65536 words of 32 bits, the expected number of collisions is one half.
  EXPECT_GE(words.size(), 65536u - 5);
  EXPECT_NE(hash(1, 2), hash(2, 1));
}

TEST(Random, OneBitOfTheKeyChangesHalfOfTheWord) {
  for (int argument = 0; argument < 4; ++argument) {
    for (int bit = 0; bit < 32; ++bit) {
      int changed = 0;
      for (std::uint32_t i = 0; i < 1000; ++i) {
        std::uint32_t key[4] = {i, i * 3, i ^ 77, 5};
        const std::uint32_t before = hash(key[0], key[1], key[2], key[3]);
        key[argument] ^= 1u << bit;
        changed += std::popcount(before ^ hash(key[0], key[1], key[2], key[3]));
      }
      // 32000 coin flips: the standard deviation is 89; the bound is six of them plus the known bias of the mixer.
      EXPECT_NEAR(changed, 16000, 600) << argument << ' ' << bit;
    }
  }
}

TEST(Random, UnitFloatsAreUniform) {
  EXPECT_EQ(unit_float(0), 0);
  EXPECT_EQ(unit_float(~0u), 1 - 0x1p-24f);
  std::vector<int> bins(64);
  for (std::uint32_t i = 0; i < 640000; ++i) ++bins[static_cast<std::size_t>(unit_float(hash(i)) * 64)];
  for (const int count : bins) EXPECT_NEAR(count, 10000, 600);
}

}  // namespace
}  // namespace zoneplate
