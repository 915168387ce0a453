// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/adaptive_disc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Point = AdaptiveDisc::Point;
using Function = std::function<bool(double x, double y)>;

bool value_at(const Function& f, const Point& p) {
  const double radius = std::sqrt(double{p.square});
  return f(radius * double{p.cosine}, radius * double{p.sine});
}
double mean_of(const AdaptiveDisc& disc, std::uint32_t seed, const Function& f) {
  return disc.mean(seed, [&](const Point* points, int count, float* values) {
    for (int i = 0; i < count; ++i) values[i] = value_at(f, points[i]) ? 1.0f : 0.0f;
  });
}
double mean_of_spiral(const DiscSpiral& spiral, std::uint32_t seed, const Function& f) {
  const TurnedSpiral turned(spiral, seed);
  int sum = 0;
  for (int i = 0; i < spiral.count(); ++i) sum += value_at(f, turned(static_cast<std::uint32_t>(i)));
  return sum / static_cast<double>(spiral.count());
}
double random_number(std::uint32_t a, std::uint32_t b) { return double{unit_float(hash(a, b, 77))}; }

/// The error of means, in 255ths.
struct DiscError {
  double squares = 0, sum = 0;
  int count = 0;
  void add(double difference) { squares += difference * difference, sum += difference, ++count; }
  double rms() const { return 255 * std::sqrt(squares / count); }
  double bias() const { return 255 * sum / count; }
};

/// Discs of one radius at random places of the unit disc.
Function dots(double radius, int number, std::uint32_t seed) {
  struct Dot {
    double x, y;
  };
  std::vector<Dot> centres;
  for (std::uint32_t i = 0; static_cast<int>(centres.size()) < number; ++i) {
    const Dot d{2 * random_number(seed, 2 * i) - 1, 2 * random_number(seed, 2 * i + 1) - 1};
    if (d.x * d.x + d.y * d.y < 1) centres.push_back(d);
  }
  return [=](double x, double y) {
    for (const Dot& d : centres)
      if ((x - d.x) * (x - d.x) + (y - d.y) * (y - d.y) < radius * radius) return true;
    return false;
  };
}

TEST(AdaptiveDisc, EvaluatesAsManyPointsOfTheDiscAsItHas) {
  for (const int count : {1, 16, 64, 191, 192, 193, 256, 1000, 4096})
    for (const double edge : {-2.0, 0.3}) {
      int evaluated = 0;
      const AdaptiveDisc disc(count);
      disc.mean(5, [&](const Point* points, int n, float* values) {
        EXPECT_LE(n, AdaptiveDisc::max_points);
        evaluated += n;
        for (int i = 0; i < n; ++i) {
          EXPECT_GE(points[i].square, 0.0f);
          EXPECT_LE(points[i].square, 1.0f);
          EXPECT_NEAR(points[i].cosine * points[i].cosine + points[i].sine * points[i].sine, 1.0f, 1e-5f);
          values[i] = double{points[i].cosine} > edge ? 1.0f : 0.0f;
        }
      });
      EXPECT_EQ(evaluated, count) << edge;
    }
}

TEST(AdaptiveDisc, ConstantsAreExact) {
  for (const int count : {16, 200, 250, 256})
    for (const float constant : {0.0f, 0.5f, 1.0f}) {
      const AdaptiveDisc disc(count);
      const float mean = disc.mean(9, [&](const Point*, int n, float* values) { std::fill_n(values, n, constant); });
      EXPECT_EQ(mean, constant) << count;
    }
}

// The area on one side of a chord at the distance h of the centre is acos(h) - h sqrt(1 - h^2).
TEST(AdaptiveDisc, AnEdgeHasHalfTheErrorOfASpiral) {
  for (const int count : {192, 256, 1000}) {
    const AdaptiveDisc disc(count);
    const DiscSpiral spiral(count);
    DiscError adaptive, even;
    for (std::uint32_t seed = 0; seed < 2000; ++seed) {
      const double angle = 6.283185307 * random_number(seed, 1), h = 2 * random_number(seed, 2) - 1;
      const Function f = [&](double x, double y) { return x * std::cos(angle) + y * std::sin(angle) > h; };
      const double exact = (std::acos(h) - h * std::sqrt(1 - h * h)) / 3.141592653589793;
      adaptive.add(mean_of(disc, seed, f) - exact);
      even.add(mean_of_spiral(spiral, seed, f) - exact);
    }
    EXPECT_LT(adaptive.rms(), even.rms() * 0.55) << count;
    EXPECT_LT(std::abs(adaptive.bias()), 0.15 * adaptive.rms() + 0.02) << count;
  }
}

// Dots between the corners of the grid are neither lost nor counted as whole cells. The header names the factor.
TEST(AdaptiveDisc, SmallFeaturesAreNotLost) {
  struct Case {
    double radius;
    int number;
  };
  const AdaptiveDisc disc(256);
  const DiscSpiral spiral(256), reference(6000);
  for (const Case c : {Case{0.02, 8}, {0.02, 100}, {0.03, 200}, {0.05, 12}, {0.08, 2}, {0.08, 45}, {0.15, 4}}) {
    DiscError adaptive, even;
    for (std::uint32_t seed = 0; seed < 150; ++seed) {
      const Function f = dots(c.radius, c.number, seed);
      const double exact = mean_of_spiral(reference, seed, f);
      adaptive.add(mean_of(disc, seed, f) - exact);
      even.add(mean_of_spiral(spiral, seed, f) - exact);
    }
    EXPECT_LT(adaptive.rms(), 1.5 * even.rms()) << c.radius << " " << c.number;
    EXPECT_LT(std::abs(adaptive.bias()), 1) << c.radius << " " << c.number;
  }
}

}  // namespace
}  // namespace zoneplate
