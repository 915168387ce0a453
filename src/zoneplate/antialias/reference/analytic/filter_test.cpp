// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/filter.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/reference/analytic/flat_triangles_for_test.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate::antialias {
namespace {

constexpr const char* names[] = {"box", "tent", "quadratic", "b-spline", "mitchell", "catmull-rom"};

/// A convex polygon inside of the pixel: a triangle clipped to its sides.
ConvexPolygon some_polygon(Numbers& random) {
  ConvexPolygon out;
  do {
    out = unit_square();
    for (int k = 0; k < 3; ++k) {
      const double a = random(-1, 1), b = random(-1, 1), length = std::sqrt(a * a + b * b);
      out = clipped(out, {a / length, b / length, -(a * random(0, 1) + b * random(0, 1)) / length + random(0, 0.5)});
      if (out.empty()) break;
    }
  } while (out.empty());
  return out;
}

TEST(AnalyticFilter, IsTheKernelOfItsName) {
  for (const char* name : names) {
    if (std::string_view(name) == "quadratic") continue;
    const Kernel kernel = make_kernel(name);
    const PolynomialFilter filter(name);
    for (double x = -3.001; x < 3; x += 0.013) EXPECT_NEAR(filter.value(x), kernel.value(x), 1e-14) << name << x;
  }
  // The quadratic filter is the convolution of box and tent: its derivative is the tent's difference over a pixel.
  const Kernel tent = make_kernel("tent");
  const PolynomialFilter quadratic("quadratic");
  for (double x = -2.001; x < 2; x += 0.013)
    EXPECT_NEAR(quadratic.value(x), tent.integral(x + 0.5) - tent.integral(x - 0.5), 1e-14);
}

TEST(AnalyticFilter, WeightsOfAnyPolygonSumToItsArea) {
  // All six filters are partitions of unity: the weights of a point for all pixels sum to 1.
  for (const char* name : names) {
    const PolynomialFilter filter(name);
    Numbers random(5);
    for (int k = 0; k < 200; ++k) {
      const ConvexPolygon polygon = some_polygon(random);
      std::vector<double> weights(filter.weight_count());
      filter.add_weights(polygon, weights);
      double sum = 0;
      for (const double w : weights) sum += w;
      EXPECT_NEAR(sum, area_moments(polygon).area, 1e-13) << name;
    }
  }
}

TEST(AnalyticFilter, WeightsAreTheIntegralsThatQuadratureFinds) {
  // The midpoint rule over many thin rows, each clipped exactly.
  for (const char* name : names) {
    const PolynomialFilter filter(name);
    Numbers random(11);
    for (int k = 0; k < 4; ++k) {
      const ConvexPolygon polygon = some_polygon(random);
      std::vector<double> weights(filter.weight_count()), expected(filter.weight_count());
      filter.add_weights(polygon, weights);
      constexpr int n = 64;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          ConvexPolygon cell = polygon;
          for (const Line& side : {Line{1, 0, -i / double{n}},
                                   {-1, 0, (i + 1) / double{n}},
                                   {0, 1, -j / double{n}},
                                   {0, -1, (j + 1) / double{n}}})
            if (!cell.empty()) cell = clipped(cell, side);
          if (cell.empty()) continue;
          const AreaMoments m = area_moments(cell);
          if (!(m.area > 0)) continue;
          const double x = m.x / m.area, y = m.y / m.area;
          for (int ky = 0; ky < filter.span(); ++ky)
            for (int kx = 0; kx < filter.span(); ++kx)
              expected[static_cast<std::size_t>(ky * filter.span() + kx)] +=
                  m.area * filter.value(x - (kx - filter.radius()) - 0.5) *
                  filter.value(y - (ky - filter.radius()) - 0.5);
        }
      for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(weights[i], expected[i], 4e-5) << name << " " << i;
    }
  }
}

TEST(AnalyticFilter, AtThePicturesSidesTheSharesAreThoseInside) {
  for (const char* name : names) {
    const PolynomialFilter filter(name);
    for (const int size : {1, 2, 3, 9})
      for (int pixel = 0; pixel < size; ++pixel) {
        double expected = 0;
        constexpr int n = 2000;
        for (int i = 0; i < n * size; ++i) expected += filter.value((i + 0.5) / n - pixel - 0.5) / n;
        EXPECT_NEAR(filter.share_inside(pixel, size), expected, 1e-6) << name << " " << pixel << " of " << size;
      }
  }
}

}  // namespace
}  // namespace zoneplate::antialias
