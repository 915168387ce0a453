#include "zoneplate/base/large_array.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>

#include "zoneplate/base/parallel.h"

namespace zoneplate {

void find_pages(void* memory, std::size_t bytes) {
  constexpr std::uintptr_t page = 4096, large_page = std::uintptr_t{1} << 21;
  const auto rounded_up = [](std::uintptr_t at, std::uintptr_t to) { return (at + to - 1) / to * to; };
  const std::uintptr_t begin = rounded_up(reinterpret_cast<std::uintptr_t>(memory), page);
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  const std::uintptr_t first_large = rounded_up(begin, large_page), last_large = end / large_page * large_page;
  constexpr std::size_t least = std::size_t{1} << 19;
  if (memory == nullptr || bytes < least) return;
  if (first_large < last_large)
    ::madvise(reinterpret_cast<void*>(first_large), last_large - first_large, MADV_HUGEPAGE);
  // A share ends where a large page does. A system that knows neither request finds the pages later.
  const std::uintptr_t origin = first_large - large_page;
  parallel_ranges(end - origin, large_page, [&](std::size_t from, std::size_t to) {
    const std::uintptr_t at = std::max(origin + from, begin);
    if (at < origin + to) ::madvise(reinterpret_cast<void*>(at), origin + to - at, MADV_POPULATE_WRITE);
  });
}

}  // namespace zoneplate
