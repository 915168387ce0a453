// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/deadline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

void sleep_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

std::string error_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Deadline, HoldsOnlyWithinItsBody) {
  EXPECT_EQ(error_of([] { check_deadline(); }), "");
  EXPECT_EQ(error_of([] { with_deadline(0.001, ErrorKind::Failed, "late", [] { sleep_ms(5), check_deadline(); }); }),
            "late");
  EXPECT_EQ(error_of([] { with_deadline(1000, ErrorKind::Failed, "late", check_deadline); }), "");
  EXPECT_EQ(error_of([] { check_deadline(); }), "");
}

TEST(Deadline, OuterLimitsHoldInside) {
  EXPECT_EQ(error_of([] {
              with_deadline(0.001, ErrorKind::Failed, "outer", [] {
                with_deadline(1000, ErrorKind::Failed, "inner", [] { sleep_ms(5), check_deadline(); });
              });
            }),
            "outer");
}

TEST(Deadline, EndsLoopsOnEveryThread) {
  std::atomic<int> done = 0;
  const std::string error = error_of([&] {
    with_threads(4, [&] {
      with_deadline(0.02, ErrorKind::Failed, "late",
                    [&] { parallel_for(100000, [&](std::size_t) { sleep_ms(1), ++done; }); });
    });
  });
  EXPECT_EQ(error, "late");
  EXPECT_LT(done, 1000);
}

TEST(Deadline, ReachesSerialCodeOnOtherThreads) {
  std::atomic<int> late = 0;
  error_of([&] {
    with_threads(3, [&] {
      with_deadline(0.02, ErrorKind::Failed, "late", [&] {
        parallel_for(3, [&](std::size_t) {
          sleep_ms(40);
          late += error_of(check_deadline) == "late";
        });
      });
    });
  });
  EXPECT_EQ(late, 3);
}

}  // namespace
}  // namespace zoneplate
