// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/loop_times.h"
#include "zoneplate/base/processors.h"

namespace zoneplate {
namespace {

/// One loop; each free thread takes its next item.
struct Loop {
  const std::function<void(std::size_t)>& body;
  const std::size_t count;
  const Deadline* const deadline;  ///< of the thread that started the loop
  const Isa isa;                   ///< of the same thread
  std::exception_ptr error;        ///< the first one; guarded by the team's mutex
  std::atomic<int> helpers = 0;    ///< threads that work on it, besides the one that started it
  alignas(64) std::atomic<std::size_t> next = 0;
};

/// Polls `is_so` for about 50 µs, which is the time for waking a sleeping thread; returns its last value.
template <class Condition>
bool becomes_true(Condition is_so) {
  constexpr std::chrono::microseconds patience(50);
  const auto start = std::chrono::steady_clock::now();
  do {
    if (is_so()) return true;
    std::this_thread::yield();
  } while (std::chrono::steady_clock::now() - start < patience);
  return is_so();
}

/// The threads of one `with_threads`. They are started for the first loop that needs them, work on any open loop
/// including nested ones, sleep in between, and end with their team.
class Team {
 public:
  explicit Team(int limit) : limit_(limit) {}
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  void run(std::size_t count, const std::function<void(std::size_t)>& body);
  int limit() const { return limit_; }

 private:
  void start(std::size_t helpers);
  void help(int index);
  void work(Loop& loop);
  Loop* join_a_loop();
  void leave(Loop& loop);

  const int limit_;
  std::mutex mutex_;
  std::vector<std::thread> threads_;
  std::vector<Loop*> open_;  ///< the newest last
  bool is_ending_ = false;
  std::atomic<std::uint32_t> news_ = 0;  ///< number of opened loops, plus one for the end
  std::atomic<std::uint32_t> left_ = 0;  ///< number of times that a helper has left a loop
};

/// The team of the calling thread, and the thread's index in it.
struct Place {
  Team* team = nullptr;
  int index = 0;
};
thread_local Place place;

/// The measurement of `time_loops` on the calling thread, outside of loops.
thread_local WorkTimes* measured = nullptr;

/// Runs a loop on one thread and measures its items; nested loops are part of them.
void measure_loop(std::size_t count, const std::function<void(std::size_t)>& body) {
  struct Return {
    WorkTimes* times;
    ~Return() { measured = times; }
  } const back{std::exchange(measured, nullptr)};
  LoopTimes& items = back.times->loops.emplace_back(count);
  Stopwatch watch;
  for (std::size_t i = 0; i < count; ++i) {
    check_deadline();
    body(i);
    items[i] = watch.lap_ms();
  }
}

Team::~Team() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  ++news_;
  news_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Team::start(std::size_t helpers) {
  const std::lock_guard lock(mutex_);
  const std::size_t needed = std::min(helpers, static_cast<std::size_t>(limit_ - 1));
  try {
    while (threads_.size() < needed) {
      const int index = static_cast<int>(threads_.size()) + 1;
      threads_.emplace_back([this, index] { help(index); });
    }
  } catch (const std::system_error&) {
    // No more threads can be created: the existing ones do the work.
  }
}

void Team::help(int index) {
  place = {this, index};
  for (;;) {
    const std::uint32_t news = news_;
    if (Loop* loop = join_a_loop()) {
      work(*loop);
      leave(*loop);
      continue;
    }
    {
      const std::lock_guard lock(mutex_);
      if (is_ending_) return;
    }
    if (!becomes_true([&] { return news_ != news; })) news_.wait(news);
  }
}

Loop* Team::join_a_loop() {
  const std::lock_guard lock(mutex_);
  for (auto loop = open_.rbegin(); loop != open_.rend(); ++loop) {
    if ((*loop)->next >= (*loop)->count) continue;
    ++(*loop)->helpers;
    return *loop;
  }
  return nullptr;
}

void Team::work(Loop& loop) {
  const Deadline* const outer = exchange_deadline(loop.deadline);
  const Isa outer_isa = exchange_isa(loop.isa);
  try {
    for (std::size_t i = loop.next++; i < loop.count; i = loop.next++) {
      check_deadline();
      loop.body(i);
    }
  } catch (...) {
    loop.next = loop.count;
    const std::lock_guard lock(mutex_);
    if (!loop.error) loop.error = std::current_exception();
  }
  exchange_isa(outer_isa);
  exchange_deadline(outer);
}

/// The loop may be destroyed as soon as the last helper has left, so that it is not accessed after the decrement.
void Team::leave(Loop& loop) {
  --loop.helpers;
  ++left_;
  left_.notify_all();
}

void Team::run(std::size_t count, const std::function<void(std::size_t)>& body) {
  start(count - 1);
  Loop loop{.body = body, .count = count, .deadline = current_deadline(), .isa = current_isa()};
  {
    const std::lock_guard lock(mutex_);
    open_.push_back(&loop);
  }
  ++news_;
  news_.notify_all();
  work(loop);
  {
    const std::lock_guard lock(mutex_);
    std::erase(open_, &loop);
  }
  for (;;) {
    const std::uint32_t left = left_;
    if (becomes_true([&] { return loop.helpers == 0; })) break;
    left_.wait(left);
  }
  if (loop.error) std::rethrow_exception(loop.error);
}

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  if (measured) return measure_loop(count, body);
  if (count > 1 && !place.team) return with_threads(0, [&] { parallel_for(count, body); });
  if (count > 1 && place.team->limit() > 1) return place.team->run(count, body);
  for (std::size_t i = 0; i < count; ++i) {
    check_deadline();
    body(i);
  }
}

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  parallel_for((count + grain - 1) / grain, [&](std::size_t r) { body(r * grain, std::min(count, (r + 1) * grain)); });
}

void with_threads(int threads, const std::function<void()>& body) {
  // An explicit number of threads may exceed the number of cores.
  Team team(threads > 0 ? threads : usable_processors());
  struct Return {
    Place outer;
    ~Return() { place = outer; }
  } const back{place};
  place = {&team, 0};
  body();
}

WorkTimes time_loops(const std::function<void()>& body) {
  WorkTimes times;
  with_threads(1, [&] {
    struct Return {
      WorkTimes* outer;
      ~Return() { measured = outer; }
    } const back{std::exchange(measured, &times)};
    const Stopwatch watch;
    body();
    times.total = watch.ms();
  });
  return times;
}

int thread_index() { return place.index; }

int thread_limit() { return place.team ? place.team->limit() : usable_processors(); }

}  // namespace zoneplate
