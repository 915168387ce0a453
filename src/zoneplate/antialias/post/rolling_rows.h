// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "zoneplate/antialias/post/bordered.h"

namespace zoneplate::antialias {

/// A sliding window over rows that are derived from an image. A row is computed just before it is read, so that it is
/// still in the cache.
///
/// Shape     at(x, y) is valid as in Bordered, for y within `radius` of the row of the last make_around.
/// Edges     the outermost values are repeated beyond the sides.
template <class T>
class RollingRows {
 public:
  /// Creates a window that begins at row `first` of an image.
  RollingRows(int width, int height, int radius, int first)
      : height_(height), radius_(radius), first_(first), made_(first - radius), values_(width, rows, radius) {}

  std::ptrdiff_t stride() const { return values_.stride(); }
  const T* at(int x, int y) const { return values_.at(x, y - first_); }

  /// Computes the missing rows within the radius of row y, by `make(row of the image, values)`.
  template <class Make>
  void make_around(int y, const Make& make) {
    if (y == first_ + rows) begin_at(y);
    for (; made_ <= y + radius_; ++made_) {
      make(std::clamp(made_, 0, height_ - 1), values_.at(0, made_ - first_));
      values_.extend_row(made_ - first_);
    }
  }

 private:
  static constexpr int rows = 32;

  /// Makes row y the first one of the window, and moves the computed rows within the radius of it.
  void begin_at(int y) {
    const auto count = static_cast<std::size_t>(made_ - (y - radius_)) * static_cast<std::size_t>(stride());
    std::memmove(values_.at(-radius_, -radius_), values_.at(-radius_, y - radius_ - first_), count * sizeof(T));
    first_ = y;
  }

  int height_, radius_, first_, made_;
  Bordered<T> values_;
};

}  // namespace zoneplate::antialias
