// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/made_once.h"

#include <gtest/gtest.h>

#include <new>

#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

TEST(MadeOnce, IsMadeByTheFirstUseAlone) {
  MadeOnce<int> number;
  EXPECT_EQ(number.value([] { return 7; }), 7);
  EXPECT_EQ(number.value([] { return 8; }), 7);
}

TEST(MadeOnce, IsTriedAgainAfterAnException) {
  MadeOnce<int> number;
  for (int i = 0; i < 2; ++i) EXPECT_THROW(number.value([]() -> int { throw std::bad_alloc(); }), std::bad_alloc);
  EXPECT_EQ(number.value([] { return 9; }), 9);
}

TEST(MadeOnce, ThreadsShareOneValue) {
  MadeOnce<int> number;
  std::atomic<int> made = 0, sum = 0;
  with_threads(4, [&] { parallel_for(1000, [&](std::size_t) { sum += number.value([&] { return ++made; }); }); });
  EXPECT_EQ(made, 1);
  EXPECT_EQ(sum, 1000);
}

}  // namespace
}  // namespace zoneplate
