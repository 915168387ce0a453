// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#pragma GCC visibility push(default)
namespace zoneplate {

// Page faults dominate the time of loading a large model: touching new pages one by one takes longer than filling them.

/// Advises the system to back unused memory by large pages; a hint, which the system may ignore.
void prefer_large_pages(void* memory, std::size_t bytes);

/// The same, and prefaults the pages on all threads: for memory that a single thread then fills.
void prefault(void* memory, std::size_t bytes);

/// Reserves capacity for `size` elements in an empty vector, with prefaulted pages.
template <class T>
void reserve_large(std::vector<T>& values, std::size_t count) {
  values.reserve(count);
  prefault(values.data(), count * sizeof(T));
}

/// Resizes an empty vector to `size` elements of zero.
template <class T>
void make_large(std::vector<T>& values, std::size_t count) {
  values.reserve(count);
  prefer_large_pages(values.data(), count * sizeof(T));
  values.resize(count);
}

}  // namespace zoneplate
#pragma GCC visibility pop
