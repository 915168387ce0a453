#pragma once

#include <cstddef>
#include <vector>

namespace zoneplate {

/// Has the system find the pages of memory that is not used yet, by all threads at once; nothing else changes.
///
/// Most of the time to load a large model goes into fresh pages: one by one where they are first touched, and by one
/// thread, they take longer than what is written into them.
void find_pages(void* memory, std::size_t bytes);

/// Room for so many elements in an empty vector, its pages found.
template <class T>
void reserve_large(std::vector<T>& values, std::size_t count) {
  values.reserve(count);
  find_pages(values.data(), count * sizeof(T));
}

/// Makes an empty vector so long, its elements zero.
template <class T>
void make_large(std::vector<T>& values, std::size_t count) {
  reserve_large(values, count);
  values.resize(count);
}

}  // namespace zoneplate
