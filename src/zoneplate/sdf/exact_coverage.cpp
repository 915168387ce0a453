// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/exact_coverage.h"

#include <algorithm>
#include <cmath>

namespace zoneplate::sdf {
namespace {

/// Per row, the derivative along x of the covered area. Columns left of the image are added to the first one, and those
/// right of it have no effect.
class Accumulator {
 public:
  Accumulator(int width, int height) : cells_(width + 2, height) {}

  /// An edge in pixels.
  void add(Point a, Point b) {
    if (a.y == b.y) return;
    const double sign = a.y < b.y ? 1 : -1;
    if (a.y > b.y) std::swap(a, b);
    const double low = std::max(a.y, 0.0), high = std::min(b.y, static_cast<double>(cells_.height()));
    const double slope = (b.x - a.x) / (b.y - a.y);
    for (int row = static_cast<int>(low); row < high; ++row) {
      const double y0 = std::max(low, static_cast<double>(row)), y1 = std::min(high, row + 1.0);
      if (y1 > y0) add_in_row(row, a.x + slope * (y0 - a.y), a.x + slope * (y1 - a.y), sign * (y1 - y0));
    }
  }

  Plane<double> take() { return std::move(cells_); }

 private:
  /// An edge of signed height `height` within a row.
  void add_in_row(int row, double x0, double x1, double height) {
    const double right = cells_.width() - 2;
    if (x0 > x1) std::swap(x0, x1);
    if (x1 <= 0 || x0 == x1) return add_in_cell(row, std::clamp(x0, 0.0, right), height);
    const double per_column = height / (x1 - x0);
    if (x0 < 0) add_in_cell(row, 0, -x0 * per_column), x0 = 0;
    for (double x = x0; x < x1;) {
      if (x >= right) return;
      const double next = std::min(x1, std::floor(x) + 1);
      add_in_cell(row, (x + next) / 2, (next - x) * per_column, static_cast<int>(x));
      x = next;
    }
  }
  /// An edge around x within one cell, whose area to the right starts at x on average.
  void add_in_cell(int row, double x, double height) { add_in_cell(row, x, height, static_cast<int>(x)); }
  void add_in_cell(int row, double x, double height, int column) {
    const double part = 1 - (x - column);
    cells_(column, row) += height * part;
    cells_(column + 1, row) += height * (1 - part);
  }

  Plane<double> cells_;
};

/// The number of lines for a curve whose control polygon has these second differences: the error of n lines is at most
/// |second derivative| / (8 n²).
int line_count(const Segment& s) {
  constexpr double tolerance = 1e-5;
  const double bend = std::max(length(s.acceleration(0)), length(s.acceleration(1)));
  return std::clamp(static_cast<int>(std::ceil(std::sqrt(bend / (8 * tolerance)))), 1, 10'000);
}

}  // namespace

Plane<float> exact_coverage(const Outline& outline, const Raster& raster) {
  Accumulator accumulator(raster.width, raster.height);
  const Outline pixels = outline.mapped({.scale = raster.scale, .move = raster.origin * -raster.scale});
  for (const Contour& contour : pixels.contours)
    for (const Segment& segment : contour) {
      const int n = segment.degree == 1 ? 1 : line_count(segment);
      Point before = segment.first();
      for (int i = 1; i <= n; ++i) {
        const Point p = i == n ? segment.last() : segment.at(static_cast<double>(i) / n);
        accumulator.add(before, p);
        before = p;
      }
    }
  const Plane<double> cells = accumulator.take();
  Plane<float> out(raster.width, raster.height);
  for (int y = 0; y < raster.height; ++y) {
    double sum = 0;
    for (int x = 0; x < raster.width; ++x) {
      sum += cells(x, y);
      double area = std::abs(sum);
      if (outline.fill == Outline::Fill::EvenOdd) area = std::abs(area - 2 * std::floor(area / 2 + 0.5));
      out(x, y) = static_cast<float>(std::min(area, 1.0));
    }
  }
  return out;
}

}  // namespace zoneplate::sdf
