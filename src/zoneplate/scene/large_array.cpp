#include "zoneplate/scene/large_array.h"

#include <sys/mman.h>

#include <cstdint>

namespace zoneplate {

void prefer_large_pages(void* memory, std::size_t bytes) {
  constexpr std::uintptr_t page = 1 << 21;
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  if (memory != nullptr && begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace zoneplate
