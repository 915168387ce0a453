// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace zoneplate::antialias {

/// The last four rows derived from an image, each with two values before and 33 after it that repeat the outermost.
template <class T>
class RowWindow {
 public:
  explicit RowWindow(int width) : width_(static_cast<std::size_t>(width)), values_(4 * stride()) {}

  T* begin_row(int y) { return values_.data() + static_cast<std::size_t>((y + 8) % 4) * stride() + before; }
  void end_row(int y) {
    T* row = begin_row(y);
    std::fill(row - before, row, row[0]);
    std::fill(row + width_, row + width_ + after, row[width_ - 1]);
  }

 private:
  static constexpr std::size_t before = 2, after = 33;
  std::size_t stride() const { return width_ + before + after; }
  std::size_t width_;
  std::vector<T> values_;
};

}  // namespace zoneplate::antialias
