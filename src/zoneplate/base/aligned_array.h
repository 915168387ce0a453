// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace zoneplate {

/// An array with the alignment of a cache line, as the kernels require of their planes; initially zero.
template <class T>
class AlignedArray {
 public:
  explicit AlignedArray(std::size_t size = 0) : lines_((size + in_line - 1) / in_line) {}

  T* data() { return lines_.empty() ? nullptr : lines_[0].values; }

 private:
  static constexpr std::size_t in_line = 64 / sizeof(T);
  struct alignas(64) Line {
    T values[in_line];
  };
  std::vector<Line> lines_;
};

}  // namespace zoneplate
