// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <future>

namespace zoneplate {

/// Runs work in the background: frames are encoded and written while the next ones are drawn.
///
/// At most thread_limit() tasks run at a time, with one thread each; if the limit is one, `run` executes the work
/// itself. Tasks may end in any order.
class Background {
 public:
  /// Waits for running tasks and ignores their errors; call `wait` first.
  ~Background();

  /// Starts the work as soon as a task is free. Rethrows exceptions of earlier work.
  void run(std::function<void()> work);
  /// Waits for all work. Rethrows its exceptions.
  void wait();

 private:
  void wait_for_first();
  std::deque<std::future<void>> running_;
};

}  // namespace zoneplate
