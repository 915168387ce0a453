#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "zoneplate/antialias/post/bordered.h"

namespace zoneplate::antialias {

/// What is made of a picture's rows and is within reach of one row after the other, made just before it is looked at,
/// so that it is still in the caches.
///
/// Shape     at(x, y) is valid as in Bordered, for y within reach of the last row that was asked for.
/// Edges     beyond the sides the outermost values go on.
template <class T>
class RollingRows {
 public:
  /// For rows from `first` on of a picture.
  RollingRows(int width, int height, int reach, int first)
      : height_(height), reach_(reach), first_(first), made_(first - reach), values_(width, rows, reach) {}

  std::ptrdiff_t stride() const { return values_.stride(); }
  const T* at(int x, int y) const { return values_.at(x, y - first_); }

  /// Makes what is in reach of row y and was not made for the row before it: `make(row of the picture, values)`.
  template <class Make>
  void make_around(int y, const Make& make) {
    if (y == first_ + rows) begin_at(y);
    for (; made_ <= y + reach_; ++made_) {
      make(std::clamp(made_, 0, height_ - 1), values_.at(0, made_ - first_));
      values_.extend_row(made_ - first_);
    }
  }

 private:
  static constexpr int rows = 32;

  /// Lets row y be the first, and moves what is made and in its reach there.
  void begin_at(int y) {
    const auto count = static_cast<std::size_t>(made_ - (y - reach_)) * static_cast<std::size_t>(stride());
    std::memmove(values_.at(-reach_, -reach_), values_.at(-reach_, y - reach_ - first_), count * sizeof(T));
    first_ = y;
  }

  int height_, reach_, first_, made_;
  Bordered<T> values_;
};

}  // namespace zoneplate::antialias
