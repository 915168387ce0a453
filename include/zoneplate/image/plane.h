// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>

#include "zoneplate/base/large_array.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// A rectangle of values of one type, row 0 at the top, rows one after the other without padding.
template <class T>
class Plane {
 public:
  /// A plane without elements.
  Plane() = default;
  /// A plane of width × height elements, all equal to `value`.
  Plane(int width, int height, T value = T{}) : Plane(unset(width, height)) {
    prefault(values_.data(), values_.size() * sizeof(T));
    std::fill_n(values_.data(), values_.size(), value);
  }
  /// A plane whose elements must be assigned before they are read.
  static Plane unset(int width, int height) {
    assert(width >= 0 && height >= 0);
    Plane plane;
    plane.width_ = width, plane.height_ = height;
    plane.values_ = LargeArray<T>::unset(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return plane;
  }

  /// Makes the plane width × height, with elements that must be assigned before they are read, in the memory that it
  /// has if its size stays.
  void fit(int width, int height) {
    if (width != width_ || height != height_) *this = unset(width, height);
  }

  /// Elements in a row.
  int width() const { return width_; }
  /// The number of rows.
  int height() const { return height_; }
  /// True if the plane has no elements, as planes of a Frame that no request names.
  bool empty() const { return values_.size() == 0; }

  ///@{
  /// The element in column x from the left and row y from the top.
  /// Requires  0 <= x < width(), 0 <= y < height().
  T& operator()(int x, int y) { return values_.data()[index(x, y)]; }
  const T& operator()(int x, int y) const { return values_.data()[index(x, y)]; }
  ///@}
  ///@{
  /// Row y from the top, left to right.
  /// Requires  0 <= y < height().
  std::span<T> row(int y) { return {values_.data() + index(0, y), static_cast<std::size_t>(width_)}; }
  std::span<const T> row(int y) const { return {values_.data() + index(0, y), static_cast<std::size_t>(width_)}; }
  ///@}
  ///@{
  /// All elements: (x, y) is number y width() + x.
  std::span<T> values() { return {values_.data(), values_.size()}; }
  std::span<const T> values() const { return {values_.data(), values_.size()}; }
  ///@}

  bool operator==(const Plane&) const = default;

 private:
  std::size_t index(int x, int y) const {
    assert(x >= 0 && y >= 0 && y < std::max(1, height_) && x < std::max(1, width_));
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_ = 0;
  int height_ = 0;
  LargeArray<T> values_;
};

}  // namespace zoneplate
#pragma GCC visibility pop
