// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/output/background.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

TEST(Background, WorkGoesOnBesideTheCallerAndNoMoreThanThereIsRoomFor) {
  std::atomic<bool> may_go = false;
  std::atomic<int> going = 0, most = 0, done = 0;
  const auto work = [&] {
    const int now = ++going;
    for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
    }
    while (!may_go) std::this_thread::yield();
    --going, ++done;
  };
  with_threads(2, [&] {
    Background background;
    background.run(work), background.run(work);
    may_go = true;  // reached only if `run` does not block
    for (int i = 0; i < 20; ++i) background.run(work);
    background.wait();
  });
  EXPECT_EQ(done, 22);
  EXPECT_LE(most, 2);
}

TEST(Background, OneThreadDoesItAtOnce) {
  with_threads(1, [] {
    const auto caller = std::this_thread::get_id();
    std::thread::id worker;
    Background().run([&] { worker = std::this_thread::get_id(); });
    EXPECT_EQ(worker, caller);
  });
}

TEST(Background, WhatTheWorkThrowsReachesTheCaller) {
  for (const int threads : {1, 2})
    with_threads(threads, [] {
      Background background;
      const auto fail = [&] {
        for (int i = 0; i < 3; ++i) background.run([] { throw std::runtime_error("disk full"); });
        background.wait();
      };
      EXPECT_THROW(fail(), std::runtime_error);
    });
}

}  // namespace
}  // namespace zoneplate
