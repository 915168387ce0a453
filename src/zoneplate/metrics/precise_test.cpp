#include "zoneplate/metrics/precise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/math/random.h"

namespace zoneplate::metrics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A number whose logarithm is uniform over 2^-40 .. 2^40.
double some_number(std::uint32_t i) {
  return static_cast<double>(std::exp2(80.0L * unit_float(hash(i)) - 40)) * (1 + unit_float(hash(i, 1)));
}

double relative_error(double value, long double truth) {
  return static_cast<double>(std::abs(value - truth) / std::abs(truth));
}

TEST(Precise, LogarithmAndExponentialAreThoseOfLongDouble) {
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const double x = some_number(i);
    EXPECT_LE(relative_error(precise_log(x), std::log(static_cast<long double>(x))), 4e-16) << x;
    const double y = 1400.0 * unit_float(hash(i, 2)) - 700;
    EXPECT_LE(relative_error(precise_exp(y), std::exp(static_cast<long double>(y))), 4e-16) << y;
  }
  EXPECT_EQ(precise_log(1), 0);
  EXPECT_EQ(precise_exp(0), 1);
  EXPECT_EQ(precise_exp(-infinity), 0);
  EXPECT_EQ(precise_exp(infinity), infinity);
}

TEST(Precise, PowersAndRoots) {
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const double x = some_number(i);
    EXPECT_LE(relative_error(precise_cube_root(x), std::cbrt(static_cast<long double>(x))), 4e-16) << x;
    const double y = 2.0 * unit_float(hash(i, 3)) - 1;
    const double bound = 2e-16 * (2 + std::abs(y * std::log(x)));
    EXPECT_LE(relative_error(precise_power(x, y), std::pow(static_cast<long double>(x), static_cast<long double>(y))),
              bound)
        << x << ' ' << y;
  }
  EXPECT_EQ(precise_power(0, 0.7), 0);
  EXPECT_EQ(precise_cube_root(0), 0);
}

TEST(Precise, Cosine) {
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const double turns = 64.0 * unit_float(hash(i, 4)) - 32;
    const long double reduced = static_cast<long double>(turns) - std::floor(static_cast<long double>(turns));
    EXPECT_NEAR(cos_turns(turns), static_cast<double>(std::cos(2 * 3.14159265358979323846264338328L * reduced)), 4e-16)
        << turns;
  }
  EXPECT_EQ(cos_turns(0), 1);
  EXPECT_EQ(cos_turns(0.5), -1);
  EXPECT_EQ(cos_turns(0.25), 0);
  EXPECT_EQ(sinc(0), 1);
  EXPECT_NEAR(sinc(0.5), 2 / pi, 1e-15);
}

TEST(Precise, DecimalLogarithm) {
  EXPECT_NEAR(precise_log10(1000), 3, 1e-15);
  EXPECT_EQ(precise_log10(0), -infinity);
  EXPECT_EQ(precise_log10(infinity), infinity);
}

}  // namespace
}  // namespace zoneplate::metrics
