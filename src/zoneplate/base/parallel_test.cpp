// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace zoneplate {
namespace {

TEST(Parallel, CallsEveryIndexOnce) {
  for (const int threads : {1, 2, 7}) {
    with_threads(threads, [] {
      for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
        std::vector<std::atomic<int>> calls(count);
        parallel_for(count, [&](std::size_t i) { ++calls[i]; });
        EXPECT_TRUE(std::all_of(calls.begin(), calls.end(), [](const auto& n) { return n == 1; }));
      }
    });
  }
}

TEST(Parallel, RangesDoNotDependOnThreads) {
  using Ranges = std::vector<std::pair<std::size_t, std::size_t>>;
  const Ranges expected = {{0, 4}, {4, 8}, {8, 10}};
  for (const int threads : {1, 2, 7}) {
    with_threads(threads, [&] {
      std::mutex mutex;
      Ranges ranges;
      parallel_ranges(10, 4, [&](std::size_t begin, std::size_t end) {
        const std::lock_guard lock(mutex);
        ranges.emplace_back(begin, end);
      });
      std::sort(ranges.begin(), ranges.end());
      EXPECT_EQ(ranges, expected);
    });
  }
}

TEST(Parallel, RethrowsTheException) {
  for (const int threads : {1, 2, 7}) {
    with_threads(threads, [] {
      const auto throw_at_77 = [](std::size_t i) {
        if (i == 77) throw std::runtime_error("77");
      };
      EXPECT_THROW(parallel_for(100, throw_at_77), std::runtime_error);
    });
  }
}

TEST(Parallel, ThreadsTakePartAndHaveNumbersOfTheirOwn) {
  // Each item waits for the others, so that three threads must execute one each.
  with_threads(3, [] {
    std::atomic<int> here = 0;
    std::vector<int> index(3);
    parallel_for(3, [&](std::size_t i) {
      index[i] = thread_index();
      ++here;
      while (here < 3) std::this_thread::yield();
    });
    std::sort(index.begin(), index.end());
    EXPECT_EQ(index, (std::vector{0, 1, 2}));
  });
}

TEST(Parallel, HelpersOfANestedLoopComeFromTheSameTeam) {
  with_threads(2, [] {
    std::atomic<int> here = 0;
    parallel_for(1, [&](std::size_t) {
      parallel_for(2, [&](std::size_t) {
        ++here;
        while (here < 2) std::this_thread::yield();
      });
    });
    EXPECT_EQ(here, 2);
  });
}

TEST(Parallel, ManyLoopsOneAfterTheOther) {
  with_threads(4, [] {
    std::atomic<std::size_t> sum = 0;
    for (std::size_t i = 0; i < 5000; ++i) parallel_for(i % 5, [&](std::size_t k) { sum += k; });
    EXPECT_EQ(sum, 1000u * (0 + 0 + 1 + 3 + 6));
    EXPECT_THROW(parallel_for(50, [](std::size_t) { throw std::runtime_error("all"); }), std::runtime_error);
    parallel_for(10, [&](std::size_t) { ++sum; });
    EXPECT_EQ(sum, 10010u);
  });
}

TEST(Parallel, LoopsOutsideHaveThreadsToo) {
  std::atomic<int> calls = 0;
  parallel_for(100, [&](std::size_t) {
    EXPECT_LT(thread_index(), thread_limit());
    ++calls;
  });
  EXPECT_EQ(calls, 100);
  EXPECT_EQ(thread_index(), 0);
}

TEST(Parallel, NestsWithinTheInnermostLimit) {
  with_threads(3, [] {
    EXPECT_EQ(thread_limit(), 3);
    with_threads(1, [] { EXPECT_EQ(thread_limit(), 1); });
    std::atomic<int> sum = 0;
    parallel_for(10, [&](std::size_t) {
      EXPECT_LT(thread_index(), thread_limit());
      EXPECT_GE(thread_index(), 0);
      parallel_for(10, [&](std::size_t) { ++sum; });
    });
    EXPECT_EQ(sum, 100);
  });
}

}  // namespace
}  // namespace zoneplate
