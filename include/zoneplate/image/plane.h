#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "zoneplate/base/api.h"
#include "zoneplate/base/large_array.h"

namespace ZONEPLATE_API zoneplate {

/// A rectangle of values of one type, row 0 at the top, rows one after the other without padding.
template <class T>
class Plane {
 public:
  Plane() = default;
  Plane(int width, int height, T value = T{}) : width_(width), height_(height) {
    assert(width >= 0 && height >= 0);
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    reserve_large(values_, count);
    values_.assign(count, value);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return values_.empty(); }

  T& operator()(int x, int y) { return values_[index(x, y)]; }
  const T& operator()(int x, int y) const { return values_[index(x, y)]; }
  std::span<T> row(int y) { return {values_.data() + index(0, y), static_cast<std::size_t>(width_)}; }
  std::span<const T> row(int y) const { return {values_.data() + index(0, y), static_cast<std::size_t>(width_)}; }
  std::span<T> values() { return values_; }
  std::span<const T> values() const { return values_; }

  bool operator==(const Plane&) const = default;

 private:
  std::size_t index(int x, int y) const {
    assert(x >= 0 && y >= 0 && y < std::max(1, height_) && x < std::max(1, width_));
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_ = 0;
  int height_ = 0;
  std::vector<T> values_;
};

}  // namespace zoneplate
