// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#pragma GCC visibility push(default)
namespace zoneplate {

/// Calls `body(i)` for every i in [0, count), on the threads of the innermost `with_threads`.
///
/// Each call may run on any thread, in any order; a body writes only what belongs to its i. The first
/// exception thrown by a body is rethrown here, after which the remaining calls may be skipped. Limits on time
/// (base/deadline.h) are checked before each call and hold on every thread.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

/// Calls `body(begin, end)` over consecutive ranges of at most `grain` items that cover [0, count).
///
/// The ranges are the same for every number of threads: [0, grain), [grain, 2 grain), ...
void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

/// Runs `body` with `threads` threads at most (0: usable_processors(), base/processors.h).
///
/// Cost      the threads are started by the first loop that has work for them and end with `body`; a loop outside of
///           every `with_threads` has threads of its own.
void with_threads(int threads, const std::function<void()>& body);

/// The index of the calling thread within the innermost `with_threads`, in [0, thread_limit()).
int thread_index();

/// The greatest number of threads that `parallel_for` may use here.
int thread_limit();

/// An object for each thread that takes part in the loops of the innermost `with_threads`: buffers that a thread keeps
/// from item to item, and sums that are added up after the loop.
template <class T>
class PerThread {
 public:
  /// Makes no object yet. It must be constructed inside the `with_threads` in which it is used.
  PerThread() : objects_(static_cast<std::size_t>(thread_limit())) {}

  /// The calling thread's own, which the first call on the thread makes from `arguments`.
  template <class... Arguments>
  T& local(const Arguments&... arguments) {
    std::unique_ptr<T>& own = objects_[static_cast<std::size_t>(thread_index())];
    if (!own) own = std::make_unique<T>(arguments...);
    return *own;
  }

  /// Calls `body(object)` for every one that was made.
  template <class Body>
  void for_each(const Body& body) const {
    for (const std::unique_ptr<T>& object : objects_)
      if (object) body(*object);
  }

 private:
  std::vector<std::unique_ptr<T>> objects_;
};

}  // namespace zoneplate
#pragma GCC visibility pop
