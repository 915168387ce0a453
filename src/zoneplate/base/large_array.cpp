// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/large_array.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

constexpr std::uintptr_t page = 4096, large_page = std::uintptr_t{1} << 21;

std::uintptr_t rounded_up(std::uintptr_t at, std::uintptr_t to) { return (at + to - 1) / to * to; }

}  // namespace

void prefer_large_pages(void* memory, std::size_t bytes) {
  const std::uintptr_t begin = rounded_up(reinterpret_cast<std::uintptr_t>(memory), large_page);
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / large_page * large_page;
  if (memory != nullptr && begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

void prefault(void* memory, std::size_t bytes) {
  constexpr std::size_t least = std::size_t{1} << 19;
  if (memory == nullptr || bytes < least) return;
  prefer_large_pages(memory, bytes);
  const std::uintptr_t begin = rounded_up(reinterpret_cast<std::uintptr_t>(memory), page);
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  // Each thread's part ends at a large page. On systems without this request, pages are allocated at their first use.
  const std::uintptr_t origin = begin / large_page * large_page;
  parallel_ranges(end - origin, large_page, [&](std::size_t from, std::size_t to) {
    const std::uintptr_t at = std::max(origin + from, begin);
    ::madvise(reinterpret_cast<void*>(at), origin + to - at, MADV_POPULATE_WRITE);
  });
}

void* allocate_large(std::size_t bytes) {
  // Rounding up to whole large pages may waste an eighth.
  const std::size_t whole = rounded_up(bytes, large_page);
  const bool is_whole = bytes >= large_page && whole - bytes <= bytes / 8;
  void* const memory = is_whole ? std::aligned_alloc(large_page, whole) : std::malloc(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  if (bytes >= large_page) prefer_large_pages(memory, is_whole ? whole : bytes);
  return memory;
}

void free_large(void* memory) { std::free(memory); }

}  // namespace zoneplate
