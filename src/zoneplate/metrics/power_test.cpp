// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/math/random.h"

namespace zoneplate::metrics {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// A number whose logarithm is uniform over 2^-40 .. 2^40.
double some_number(std::uint32_t i) {
  return static_cast<double>(std::exp2(80.0L * unit_float(hash(i)) - 40)) * (1 + unit_float(hash(i, 1)));
}

double relative_error(double value, long double truth) {
  return static_cast<double>(std::abs(value - truth) / std::abs(truth));
}

TEST(Power, IsThatOfLongDouble) {
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const double x = some_number(i), y = 2.0 * unit_float(hash(i, 3)) - 1;
    const double bound = 1e-15 * (1 + std::abs(y * std::log(x)));
    EXPECT_LE(relative_error(power(x, y), std::pow(static_cast<long double>(x), static_cast<long double>(y))), bound)
        << x << ' ' << y;
  }
  EXPECT_EQ(power(0, 0.7), 0);
  EXPECT_EQ(power(1, 0.3), 1);
}

TEST(CubeRoot, IsThatOfLongDouble) {
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const double x = some_number(i);
    EXPECT_LE(relative_error(cube_root(x), std::cbrt(static_cast<long double>(x))), 4e-16) << x;
  }
  EXPECT_EQ(cube_root(0), 0);
  EXPECT_EQ(cube_root(1), 1);
}

TEST(Logarithms, ToTenAndTwo) {
  EXPECT_NEAR(decimal_log(1000), 3, 1e-15);
  EXPECT_NEAR(binary_log(1024), 10, 4e-15);
  EXPECT_EQ(decimal_log(1), 0);
  EXPECT_EQ(decimal_log(0), -unbounded);
  EXPECT_EQ(decimal_log(unbounded), unbounded);
}

}  // namespace
}  // namespace zoneplate::metrics
