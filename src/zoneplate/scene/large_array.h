#pragma once

#include <cstddef>
#include <vector>

namespace zoneplate {

/// Asks the system to back memory that is not used yet by large pages, where it has any; a hint without consequences.
///
/// Most of the time to load a large model goes into finding fresh pages of 4 KB for it.
void prefer_large_pages(void* memory, std::size_t bytes);

/// Makes an empty vector so long, its elements zero.
template <class T>
void make_large(std::vector<T>& values, std::size_t count) {
  values.reserve(count);
  prefer_large_pages(values.data(), count * sizeof(T));
  values.resize(count);
}

}  // namespace zoneplate
