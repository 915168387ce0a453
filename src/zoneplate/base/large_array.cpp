#include "zoneplate/base/large_array.h"

#include <sys/mman.h>

#include <cstdint>

#include "zoneplate/base/parallel.h"

namespace zoneplate {

void find_pages(void* memory, std::size_t bytes) {
  constexpr std::uintptr_t page = 4096;
  constexpr std::size_t least = std::size_t{1} << 19, share = std::size_t{1} << 18;
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  if (memory == nullptr || bytes < least) return;
  // A system that does not know the request finds the pages later.
  parallel_ranges(end - begin, share, [&](std::size_t first, std::size_t last) {
    ::madvise(reinterpret_cast<void*>(begin + first), last - first, MADV_POPULATE_WRITE);
  });
}

}  // namespace zoneplate
