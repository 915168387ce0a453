#pragma once

#include <cstddef>
#include <functional>
#include <memory>

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

}  // namespace zoneplate
