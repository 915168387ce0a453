// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>

#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {

/// A plane with `border` more values on every side, which repeat the outermost ones, so that searches need no bounds
/// checks.
///
/// Shape     rows are `stride()` apart; at(x, y) is valid for x in [-border, width + border + 32) and y in [-border,
///           height + border). The 32 values at the end let vectors read past a row.
/// Requires  the rows are written first, then `extend` is called.
template <class T>
class Bordered {
 public:
  Bordered(int width, int height, int border)
      : width_(width),
        height_(height),
        border_(border),
        stride_(width + 2 * border + 32),
        values_(std::make_unique_for_overwrite<T[]>(static_cast<std::size_t>(stride_ * (height + 2 * border)))) {
    assert(width > 0 && height > 0 && border >= 0);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  std::ptrdiff_t stride() const { return stride_; }
  T* at(int x, int y) { return values_.get() + (y + border_) * stride_ + x + border_; }
  const T* at(int x, int y) const { return values_.get() + (y + border_) * stride_ + x + border_; }

  /// Writes the borders before and after one row.
  void extend_row(int y) {
    std::fill(at(-border_, y), at(0, y), *at(0, y));
    std::fill(at(width_, y), at(width_ + border_ + 32, y), *at(width_ - 1, y));
  }

  /// Writes the borders.
  void extend() {
    parallel_ranges(static_cast<std::size_t>(height_), 64, [&](std::size_t begin, std::size_t end) {
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) extend_row(y);
    });
    for (int i = 1; i <= border_; ++i) {
      std::copy_n(at(-border_, 0), stride_, at(-border_, -i));
      std::copy_n(at(-border_, height_ - 1), stride_, at(-border_, height_ - 1 + i));
    }
  }

  /// Writes one value into the borders; it may be called before the rows are written.
  void fill_border(T value) {
    for (int y = -border_; y < height_ + border_; ++y) {
      if (y < 0 || y >= height_) {
        std::fill(at(-border_, y), at(width_ + border_ + 32, y), value);
        continue;
      }
      std::fill(at(-border_, y), at(0, y), value);
      std::fill(at(width_, y), at(width_ + border_ + 32, y), value);
    }
  }

 private:
  int width_, height_, border_;
  std::ptrdiff_t stride_;
  std::unique_ptr<T[]> values_;
};

}  // namespace zoneplate::antialias
