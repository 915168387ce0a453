// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/adaptive_disc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Point = AdaptiveDisc::Point;

constexpr int min_count = 192;
/// From the outermost corners to the sides of the square, in cells.
constexpr float rim = 0.1f;

int cells_of(int count) {
  return count < min_count ? 0 : static_cast<int>(std::sqrt(0.4f * static_cast<float>(count))) - 1;
}
int corners_of(int count) {
  const int cells = cells_of(count);
  return cells == 0 ? 0 : (cells + 1) * (cells + 1);
}

/// The point of the disc that corresponds to one of the square [0, 1]^2.
Point of_square(float u, float v) {
  const float a = 2 * u - 1, b = 2 * v - 1;
  const bool is_wide = std::abs(a) > std::abs(b);
  const float radius = is_wide ? a : b, other = is_wide ? b : a;
  const float angle = radius == 0 ? 0 : 0.785398163f * (other / radius);
  const float sign = radius < 0 ? -1.0f : 1.0f;
  const float along = sign * cos(angle), across = sign * sin(angle);
  return {std::min(radius * radius, 1.0f), is_wide ? along : across, is_wide ? across : along, 0, 0};
}

/// A point of the grid of one receiver.
Point turned(const Point& p, const DiscTurn& turn) {
  const DiscTurn::Turned to = turn(p);
  return {p.square, to.cosine, to.sine, 0, 0};
}

/// store(i, value) of the function at point_of(i), in order.
template <class PointOf, class Store>
void evaluate(int count, const PointOf& point_of, const AdaptiveDisc::Values& values, const Store& store) {
  constexpr int part = AdaptiveDisc::max_points;
  std::array<Point, part> points;
  std::array<float, part> found;
  for (int first = 0; first < count; first += part) {
    const int n = std::min(part, count - first);
    for (int i = 0; i < n; ++i) points[static_cast<std::size_t>(i)] = point_of(first + i);
    values(points.data(), n, found.data());
    for (int i = 0; i < n; ++i) store(first + i, found[static_cast<std::size_t>(i)]);
  }
}

}  // namespace

AdaptiveDisc::AdaptiveDisc(int count)
    : cells_(cells_of(count)),
      spiral_(count - corners_of(count)),
      corner_weight_(0.7f * static_cast<float>(corners_of(count)) / static_cast<float>(std::max(count, 1))) {
  for (int i = 0; i < corners_of(count); ++i)
    corners_.push_back(of_square(corner(i % (cells_ + 1)), corner(i / (cells_ + 1))));
}

/// The coordinate of a row or column of corners in the square.
float AdaptiveDisc::corner(int i) const {
  return (static_cast<float>(i) + rim) / (static_cast<float>(cells_) + 2 * rim);
}

AdaptiveDisc::Cell AdaptiveDisc::cell(int index) const {
  const auto low = [&](int i) { return i == 0 ? 0 : corner(i); };
  const auto high = [&](int i) { return i + 1 == cells_ ? 1 : corner(i + 1); };
  const int row = index / cells_, column = index % cells_;
  return {low(column), high(column), low(row), high(row)};
}

float AdaptiveDisc::mean(std::uint32_t seed, const Values& values) const {
  if (cells_ == 0) return mean_of_spiral(seed, values);
  const DiscTurn turn(seed, 0);
  std::vector<float> at_corners(corners_.size());
  evaluate(
      static_cast<int>(corners_.size()), [&](int i) { return turned(corners_[static_cast<std::size_t>(i)], turn); },
      values, [&](int i, float value) { at_corners[static_cast<std::size_t>(i)] = value; });

  std::vector<int> uneven;
  float of_even = 0, of_uneven = 0, area = 0;
  for (int i = 0; i < cells_ * cells_; ++i) {
    const float* const v = at_corners.data() + i / cells_ * (cells_ + 1) + i % cells_;
    const float a = v[0], b = v[1], c = v[cells_ + 1], d = v[cells_ + 2];
    const float part = cell(i).area();
    area += part;
    if (a == b && a == c && a == d) {
      of_even += part * a;
      continue;
    }
    uneven.push_back(i);
    of_uneven += part * (0.25f * ((a + b) + (c + d)));
  }
  const auto found = static_cast<int>(uneven.size());
  if (found > 0 && 2 * found <= cells_ * cells_ && !has_lone_corner(at_corners))
    return std::clamp((of_even + integral_over(uneven, seed, values)) / area, 0.0f, 1.0f);
  const float of_corners = (of_even + of_uneven) / area, of_spiral = mean_of_spiral(seed, values);
  return of_spiral + corner_weight_ * (of_corners - of_spiral);
}

/// Whether one of the corners differs from all of its neighbours in its row and its column.
bool AdaptiveDisc::has_lone_corner(const std::vector<float>& at_corners) const {
  const int n = cells_ + 1;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) {
      const float* const v = at_corners.data() + row * n + column;
      if ((column == 0 || v[-1] != *v) && (column == cells_ || v[1] != *v) && (row == 0 || v[-n] != *v) &&
          (row == cells_ || v[n] != *v))
        return true;
    }
  return false;
}

/// Of the function over these cells, each with an equal number of points, or one more: a lattice with a random shift.
float AdaptiveDisc::integral_over(const std::vector<int>& cells, std::uint32_t seed, const Values& values) const {
  struct CellPoint {
    Point point;
    float weight;
  };
  std::vector<CellPoint> points;
  const DiscTurn turn(seed, 0);
  const auto number = static_cast<int>(cells.size());
  for (int k = 0; k < number; ++k) {
    const int first = spiral_.count() * k / number, count = spiral_.count() * (k + 1) / number - first;
    const auto word = static_cast<std::uint32_t>(cells[static_cast<std::size_t>(k)]);
    const Cell c = cell(cells[static_cast<std::size_t>(k)]);
    const std::uint32_t x = hash(seed, word, 5), y = hash(seed, word, 6);
    const float weight = c.area() / static_cast<float>(count);
    for (int i = 0; i < count; ++i) {
      const float across = unit_float(x) + static_cast<float>(i) / static_cast<float>(count);
      const float down = unit_float(y + static_cast<std::uint32_t>(i) * golden_step);
      const Point p =
          of_square(c.left + (across - std::floor(across)) * (c.right - c.left), c.top + down * (c.bottom - c.top));
      points.push_back({turned(p, turn), weight});
    }
  }
  float sum = 0;
  evaluate(
      static_cast<int>(points.size()), [&](int i) { return points[static_cast<std::size_t>(i)].point; }, values,
      [&](int i, float value) { sum += points[static_cast<std::size_t>(i)].weight * value; });
  return sum;
}

float AdaptiveDisc::mean_of_spiral(std::uint32_t seed, const Values& values) const {
  const TurnedSpiral spiral(spiral_, seed);
  float sum = 0;
  evaluate(
      spiral_.count(), [&](int i) { return spiral(static_cast<std::uint32_t>(i)); }, values,
      [&](int, float value) { sum += value; });
  return sum / static_cast<float>(spiral_.count());
}

}  // namespace zoneplate
