#pragma once

#include <cstddef>
#include <vector>

#include "zoneplate/base/api.h"

namespace ZONEPLATE_API zoneplate {

// Most of the time to load a large model goes into fresh pages of memory: one by one, where they are first touched,
// they take longer than what is written into them.

/// Asks the system to back memory that is not used yet by large pages, where it has any; a hint without consequences.
void prefer_large_pages(void* memory, std::size_t bytes);

/// The same, and has the pages found by all threads at once: for what one thread then fills at a stretch.
void prefault(void* memory, std::size_t bytes);

/// Room for so many elements in an empty vector, its pages found.
template <class T>
void reserve_large(std::vector<T>& values, std::size_t count) {
  values.reserve(count);
  prefault(values.data(), count * sizeof(T));
}

/// Makes an empty vector so long, its elements zero.
template <class T>
void make_large(std::vector<T>& values, std::size_t count) {
  values.reserve(count);
  prefer_large_pages(values.data(), count * sizeof(T));
  values.resize(count);
}

}  // namespace zoneplate
