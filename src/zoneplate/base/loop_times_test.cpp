// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/loop_times.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

TEST(LoopTimes, AreThoseOfOutermostLoopsOnOneThread) {
  const auto wait = [](int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); };
  WorkTimes times;
  with_threads(4, [&] {
    times = time_loops([&] {
      EXPECT_EQ(thread_limit(), 1);
      parallel_for(3, [&](std::size_t i) { parallel_for(2, [&](std::size_t) { wait(static_cast<int>(i)); }); });
      wait(5);
      parallel_for(1, [&](std::size_t) { wait(3); });
    });
  });
  ASSERT_EQ(times.loops.size(), 2u);
  ASSERT_EQ(times.loops[0].size(), 3u);
  ASSERT_EQ(times.loops[1].size(), 1u);
  EXPECT_GE(times.loops[0][1], 2);
  EXPECT_GE(times.loops[0][2], 4);
  EXPECT_GE(times.loops[1][0], 3);
  EXPECT_GE(times.serial(), 5);
  EXPECT_GE(times.total, 14);
}

TEST(LoopTimes, AFreeThreadTakesTheNextItem) {
  EXPECT_EQ(scheduled_ms({4, 1, 1, 2}, 1), 8);
  EXPECT_EQ(scheduled_ms({4, 1, 1, 2}, 2), 4);
  EXPECT_EQ(scheduled_ms({1, 1, 2, 4}, 2), 5);  // the longest item comes last
  EXPECT_EQ(scheduled_ms({4, 1, 1, 2}, 16), 4);
  EXPECT_EQ(scheduled_ms({}, 16), 0);
}

}  // namespace
}  // namespace zoneplate
