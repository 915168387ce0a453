#include "zoneplate/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace zoneplate {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  parallel_ranges(count, 1, [&](std::size_t begin, std::size_t) { body(begin); });
}

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  // The ranges are numbered, so that their bounds do not depend on how the scheduler splits them.
  const std::size_t ranges = (count + grain - 1) / grain;
  const auto run = [&](std::size_t r) { body(r * grain, std::min(count, (r + 1) * grain)); };
  if (ranges <= 1 || thread_limit() == 1) {
    for (std::size_t r = 0; r < ranges; ++r) run(r);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ranges, 1), [&](const tbb::blocked_range<std::size_t>& part) {
    for (std::size_t r = part.begin(); r != part.end(); ++r) run(r);
  });
}

void with_threads(int threads, const std::function<void()>& body) {
  const int count = threads > 0 ? threads : tbb::info::default_concurrency();
  // More threads than cores are given where they are asked for.
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  tbb::task_arena arena(count);
  arena.execute(body);
}

int thread_index() { return std::max(0, tbb::this_task_arena::current_thread_index()); }

int thread_limit() { return tbb::this_task_arena::max_concurrency(); }

}  // namespace zoneplate
