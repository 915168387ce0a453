// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/large_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace zoneplate {
namespace {

LargeArray<float> filled(std::size_t count, float value) {
  auto array = LargeArray<float>::unset(count);
  std::fill_n(array.data(), count, value);
  return array;
}

TEST(LargeArray, OwnsItsElements) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{1000}, std::size_t{3'000'000}}) {
    LargeArray<float> a = filled(count, 2);
    const LargeArray<float> copy = a;
    EXPECT_EQ(copy, a);
    EXPECT_NE(copy.data(), a.data());
    a.data()[count - 1] = 3;
    EXPECT_NE(copy, a);
    const float* const memory = a.data();
    const LargeArray<float> moved = std::move(a);
    EXPECT_EQ(moved.data(), memory);
    EXPECT_EQ(a.size(), 0u);
    EXPECT_EQ(moved.data()[count - 1], 3);
    a = copy;
    EXPECT_EQ(a, copy);
  }
  EXPECT_EQ(LargeArray<float>::unset(0), LargeArray<float>());
}

TEST(LargeArray, BeginsAtALargePageIfLittleIsWasted) {
  constexpr std::size_t large_page = std::size_t{1} << 21;
  const auto is_aligned = [](std::size_t bytes) {
    const auto array = LargeArray<unsigned char>::unset(bytes);
    return reinterpret_cast<std::uintptr_t>(array.data()) % large_page == 0;
  };
  EXPECT_TRUE(is_aligned(std::size_t{1920} * 1080 * 4));
  EXPECT_TRUE(is_aligned(100 * large_page + 1));
  EXPECT_FALSE(is_aligned(large_page + 1));
}

}  // namespace
}  // namespace zoneplate
