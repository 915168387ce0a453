#include "zoneplate/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
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
  const Ranges wanted = {{0, 4}, {4, 8}, {8, 10}};
  for (const int threads : {1, 2, 7}) {
    with_threads(threads, [&] {
      std::mutex mutex;
      Ranges ranges;
      parallel_ranges(10, 4, [&](std::size_t begin, std::size_t end) {
        const std::lock_guard lock(mutex);
        ranges.emplace_back(begin, end);
      });
      std::sort(ranges.begin(), ranges.end());
      EXPECT_EQ(ranges, wanted);
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
