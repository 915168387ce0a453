// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/edge/edge_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/metrics/charts_for_test.h"

namespace zoneplate::metrics {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

double sinc_of(double x) { return x == 0 ? 1 : std::sin(3.14159265358979323846 * x) / (3.14159265358979323846 * x); }

/// A half-plane from 0.1 to 0.9 whose edge has the angle `angle` from the vertical, with n × n samples per pixel.
LinearImage box_edge(double angle, int n) {
  return make_chart(80, 96, [=](int x, int y) {
    int inside = 0;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const double dx = x + (i + 0.5) / n - 40.3, dy = y + (j + 0.5) / n - 48;
        inside += dx * std::cos(angle) + dy * std::sin(angle) > 0;
      }
    }
    return grey(0.1 + 0.8 * inside / (n * n));
  });
}

/// An edge whose value is a function of the distance from it.
template <class Profile>
LinearImage drawn_edge(double angle, const Profile& profile) {
  return make_chart(80, 96, [&](int x, int y) {
    return grey(profile((x + 0.5 - 40.3) * std::cos(angle) + (y + 0.5 - 48) * std::sin(angle)));
  });
}

TEST(EdgeResponse, OfABoxIsTheSincAlongTheNormal) {
  for (const double angle_deg : {2.0, 5.0, 10.0, 20.0}) {
    const double angle = angle_deg * degree;
    const auto edge = measure_edge(box_edge(angle, 32));
    ASSERT_TRUE(edge);
    EXPECT_NEAR(edge->angle_deg, angle_deg, 0.05);
    for (std::size_t i = 0; i < edge->frequency.size() && edge->frequency[i] <= 0.7; ++i) {
      const double f = edge->frequency[i];
      const double box = sinc_of(f * std::cos(angle)) * sinc_of(f * std::sin(angle));
      EXPECT_NEAR(edge->transfer[i], box, 0.01) << angle_deg << "° at " << f;
    }
    EXPECT_LT(edge->overshoot, 0.01);
  }
}

TEST(EdgeResponse, PublishedHalfTransferOfTheBox) {
  const auto edge = measure_edge(box_edge(5 * degree, 32));
  ASSERT_TRUE(edge);
  EXPECT_NEAR(edge->half_transfer, 0.6034, 0.005);
  EXPECT_NEAR(edge->nyquist_transfer, 2 / 3.14159265358979, 0.01);
  EXPECT_NEAR(edge->rise, 0.8, 0.06);  // the corners of the ramp are between samples a quarter pixel apart
}

TEST(EdgeResponse, OfAGaussian) {
  // exp(-2π² σ² f²) falls to ½ at √(ln 2 / 2) / (π σ).
  constexpr double sigma = 1.2;
  const auto edge = measure_edge(
      drawn_edge(7 * degree, [](double d) { return 0.2 + 0.6 * 0.5 * std::erfc(-d / (sigma * std::sqrt(2.0))); }));
  ASSERT_TRUE(edge);
  EXPECT_NEAR(edge->half_transfer, std::sqrt(std::log(2.0) / 2) / (3.14159265358979 * sigma), 0.002);
  EXPECT_NEAR(edge->rise, 2 * 1.2815515655446 * sigma, 0.02);
  EXPECT_LT(edge->overshoot, 1e-3);
}

TEST(EdgeResponse, DoesNotCareWhichWayTheEdgeLies) {
  const LinearImage upright = box_edge(5 * degree, 8);
  const auto turned = make_chart(96, 80, [&](int x, int y) { return upright(y, x); });
  const auto swapped = make_chart(80, 96, [&](int x, int y) { return upright(79 - x, y); });
  const double half_transfer = measure_edge(upright)->half_transfer;
  EXPECT_NEAR(measure_edge(turned)->half_transfer, half_transfer, 1e-9);
  EXPECT_NEAR(measure_edge(swapped)->half_transfer, half_transfer, 0.003);
}

TEST(EdgeResponse, OfNoAntialiasingPassesAll) {
  const auto edge = measure_edge(box_edge(5 * degree, 1));
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->half_transfer, 1);
  EXPECT_GT(edge->nyquist_transfer, 0.9);
}

TEST(EdgeResponse, SeesOvershoot) {
  const auto edge = measure_edge(drawn_edge(5 * degree, [](double d) {
    const double step = std::clamp(d / 2 + 0.5, 0.0, 1.0);
    return 0.3 + 0.4 * (d > 1 && d < 3 ? step + 0.1 : step);
  }));
  ASSERT_TRUE(edge);
  EXPECT_NEAR(edge->overshoot, 0.1, 0.01);
}

TEST(EdgeResponse, IsNothingWhereLightIsNotFinite) {
  for (const float light : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    LinearImage image = box_edge(5 * degree, 4);
    for (int y = 0; y < image.height(); ++y) image(20, y) = {light, light, light, 1};
    EXPECT_FALSE(measure_edge(image));
  }
}

TEST(EdgeResponse, IsNothingWithoutASlantedEdge) {
  EXPECT_FALSE(measure_edge(LinearImage(64, 64, grey(0.5))));
  EXPECT_FALSE(measure_edge(box_edge(0, 4)));
  EXPECT_FALSE(measure_edge(LinearImage(4, 4)));
}

}  // namespace
}  // namespace zoneplate::metrics
