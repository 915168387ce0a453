// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/filter.h"

#include <cassert>
#include <cmath>

namespace zoneplate::antialias {
namespace {

using Moments = std::array<std::array<double, 4>, 4>;

/// ∫∫ x^i y^j over a polygon for i, j <= degree: ∮ x^(i+1) / (i+1) y^j dy around it.
Moments moments_of(const ConvexPolygon& polygon, int degree) {
  static constexpr double node[] = {0.06943184420297371239, 0.33000947820757186760, 0.66999052179242813240,
                                    0.93056815579702628761};
  static constexpr double weight[] = {0.17392742256872692869, 0.32607257743127307131, 0.32607257743127307131,
                                      0.17392742256872692869};
  Moments m{};
  for (int k = 0; k < polygon.count; ++k) {
    const Place p = polygon[k], q = polygon[k + 1 == polygon.count ? 0 : k + 1];
    const double dx = q.x - p.x, dy = q.y - p.y;
    if (dy == 0) continue;
    for (std::size_t g = 0; g < 4; ++g) {
      const double x = p.x + node[g] * dx, y = p.y + node[g] * dy;
      double xi = weight[g] * dy * x;
      for (int i = 0; i <= degree; ++i, xi *= x) {
        double term = xi / (i + 1);
        for (int j = 0; j <= degree; ++j, term *= y)
          m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] += term;
      }
    }
  }
  return m;
}

ConvexPolygon moved(ConvexPolygon polygon, double x, double y) {
  for (int i = 0; i < polygon.count; ++i) {
    Place& p = polygon.corner[static_cast<std::size_t>(i)];
    p = {p.x - x, p.y - y};
  }
  return polygon;
}

constexpr double third = 1.0 / 3;

}  // namespace

PolynomialFilter::PolynomialFilter(std::string_view name) {
  const auto cubic = [&](double b, double c) {
    degree_ = 3;
    pieces_ = {{1, {1 - b / 3, 0, -3 + 2 * b + c, 2 - 1.5 * b - c}},
               {2, {4 * b / 3 + 4 * c, -2 * b - 8 * c, b + 5 * c, -b / 6 - c}}};
  };
  if (name == "box") {
    pieces_ = {{0.5, {1, 0, 0, 0}}};
  } else if (name == "tent") {
    degree_ = 1;
    pieces_ = {{1, {1, -1, 0, 0}}};
  } else if (name == "quadratic") {
    degree_ = 2;
    pieces_ = {{0.5, {0.75, 0, -1, 0}}, {1.5, {1.125, -1.5, 0.5, 0}}};
  } else if (name == "b-spline") {
    cubic(1, 0);
  } else if (name == "mitchell") {
    cubic(third, third);
  } else {
    assert(name == "catmull-rom");
    cubic(0, 0.5);
  }
  const double radius = pieces_.back().end;
  radius_ = static_cast<int>(std::ceil(radius - 0.5));
  for (int h = 0; h < 2; ++h)
    for (int k = -radius_; k <= radius_; ++k) half_.push_back(expanded(0.5 * h - (k + 0.5)));
}

std::array<double, 4> PolynomialFilter::expanded(double x0) const {
  // To the left of 0 the filter is mirrored: the same pieces with -x.
  const double middle = std::abs(x0 + 0.25);
  for (const Piece& piece : pieces_) {
    if (middle > piece.end) continue;
    std::array<double, 4> p = piece.coefficient;
    if (x0 < 0) p[1] = -p[1], p[3] = -p[3];
    return {p[0] + x0 * (p[1] + x0 * (p[2] + x0 * p[3])), p[1] + x0 * (2 * p[2] + x0 * (3 * p[3])),
            p[2] + x0 * (3 * p[3]), p[3]};
  }
  return {};
}

double PolynomialFilter::value(double x) const {
  const double a = std::abs(x);
  for (const Piece& piece : pieces_)
    if (a <= piece.end) {
      const std::array<double, 4>& p = piece.coefficient;
      return p[0] + a * (p[1] + a * (p[2] + a * p[3]));
    }
  return 0;
}

void PolynomialFilter::add_weights(const ConvexPolygon& polygon, std::span<double> weights) const {
  if (radius_ == 0) {
    weights[0] += area_moments(polygon).area;
    return;
  }
  // The pieces of all pixels' filters meet at this pixel's centre lines and at its sides.
  ConvexPolygon left_right[2], quarter[2];
  cut(polygon, {-1, 0, 0.5}, left_right[0], left_right[1]);
  const auto width = static_cast<std::size_t>(span());
  for (std::size_t hx = 0; hx < 2; ++hx) {
    if (left_right[hx].empty()) continue;
    cut(left_right[hx], {0, -1, 0.5}, quarter[0], quarter[1]);
    for (std::size_t hy = 0; hy < 2; ++hy) {
      if (quarter[hy].empty()) continue;
      const Moments m =
          moments_of(moved(quarter[hy], 0.5 * static_cast<double>(hx), 0.5 * static_cast<double>(hy)), degree_);
      for (std::size_t ky = 0; ky < width; ++ky) {
        const std::array<double, 4>& fy = half_[hy * width + ky];
        double column[4] = {};
        for (std::size_t i = 0; i <= static_cast<std::size_t>(degree_); ++i)
          for (std::size_t j = 0; j <= static_cast<std::size_t>(degree_); ++j) column[i] += fy[j] * m[i][j];
        for (std::size_t kx = 0; kx < width; ++kx) {
          const std::array<double, 4>& fx = half_[hx * width + kx];
          weights[ky * width + kx] += (fx[0] * column[0] + fx[1] * column[1]) + (fx[2] * column[2] + fx[3] * column[3]);
        }
      }
    }
  }
}

double PolynomialFilter::share_inside(int pixel, int size) const {
  const auto integral = [](const std::array<double, 4>& p) {
    return 0.5 * (p[0] + 0.5 * (p[1] / 2 + 0.5 * (p[2] / 3 + 0.5 * (p[3] / 4))));
  };
  if (pixel >= radius_ && pixel < size - radius_) return 1;
  double sum = 0;
  for (int k = -radius_; k <= radius_; ++k)
    if (pixel - k >= 0 && pixel - k < size)
      for (int h = 0; h < 2; ++h) sum += integral(half_[static_cast<std::size_t>(h * span() + k + radius_)]);
  return sum;
}

}  // namespace zoneplate::antialias
