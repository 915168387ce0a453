// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#pragma GCC visibility push(default)
namespace zoneplate {

// Page faults dominate the time of loading a large model: touching new pages one by one takes longer than filling them.

/// Advises the system to back unused memory by large pages; a hint, which the system may ignore.
void prefer_large_pages(void* memory, std::size_t bytes);

/// The same, and prefaults the pages on all threads: for memory that a single thread then fills.
void prefault(void* memory, std::size_t bytes);

/// Memory for an array, for which large pages are preferred: from some megabytes on it consists of nothing else.
///
/// Errors    std::bad_alloc.
void* allocate_large(std::size_t bytes);
/// Frees memory of allocate_large.
void free_large(void* memory);

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

/// An array in the memory of allocate_large. Its size changes by assignment only.
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignof(std::max_align_t));

 public:
  LargeArray() = default;
  /// An array whose elements must be assigned before they are read.
  static LargeArray unset(std::size_t count) {
    LargeArray array;
    if (count > 0) array.data_.reset(static_cast<T*>(allocate_large(count * sizeof(T))));
    array.size_ = count;
    return array;
  }
  /// Copies the elements.
  LargeArray(const LargeArray& other) : LargeArray(unset(other.size_)) { std::copy_n(other.data(), size_, data()); }
  /// Takes the memory of the other array, which is empty afterwards.
  LargeArray(LargeArray&& other) noexcept { swap(other); }
  /// Replaces the elements by those of a copy or of a moved array.
  LargeArray& operator=(LargeArray other) noexcept {
    swap(other);
    return *this;
  }
  ~LargeArray() = default;

  /// The first element; null if the array is empty.
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }  ///< the same
  /// The number of elements.
  std::size_t size() const { return size_; }
  /// Whether both arrays have the same size and equal elements.
  bool operator==(const LargeArray& other) const {
    return size_ == other.size_ && std::equal(data(), data() + size_, other.data());
  }

 private:
  struct Free {
    void operator()(T* memory) const { free_large(memory); }
  };
  void swap(LargeArray& other) noexcept { std::swap(data_, other.data_), std::swap(size_, other.size_); }
  std::unique_ptr<T[], Free> data_;
  std::size_t size_ = 0;
};

}  // namespace zoneplate
#pragma GCC visibility pop
