// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/functions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace zoneplate {
namespace {

const long double long_pi = std::acos(-1.0L);

TEST(Functions, SinAndCosAgreeWithLongDouble) {
  for (int i = -4000; i <= 4000; ++i) {
    const double x = i * 0.001237;
    EXPECT_NEAR(sin_pi(x), static_cast<double>(std::sin(long_pi * x)), 3e-16) << x;
    EXPECT_NEAR(cos_pi(x), static_cast<double>(std::cos(long_pi * x)), 3e-16) << x;
    EXPECT_EQ(sin_pi(-x), -sin_pi(x));
    EXPECT_EQ(cos_pi(-x), cos_pi(x));
  }
  for (int i = -20; i <= 20; ++i) {
    EXPECT_EQ(sin_pi(i), 0.0);
    EXPECT_EQ(cos_pi(i + 0.5), 0.0);
    EXPECT_EQ(cos_pi(2 * i), 1.0);
    EXPECT_EQ(cos_pi(2 * i + 1), -1.0);
  }
}

TEST(Functions, UnitRootsAgreeWithLongDoubleAndAreExactAtTheAxes) {
  for (std::uint64_t n : {1u, 2u, 3u, 4u, 7u, 8u, 12u, 97u, 1000u, 4096u})
    for (std::uint64_t k = 0; k < n; ++k) {
      const SineCosine w = unit_root(k, n);
      const long double a = 2 * long_pi * static_cast<long double>(k) / static_cast<long double>(n);
      EXPECT_NEAR(w.cosine, static_cast<double>(std::cos(a)), 2.3e-16);
      EXPECT_NEAR(w.sine, static_cast<double>(std::sin(a)), 2.3e-16);
    }
  EXPECT_EQ(unit_root(1, 4).sine, 1.0);
  EXPECT_EQ(unit_root(1, 4).cosine, 0.0);
  EXPECT_EQ(unit_root(2, 4).cosine, -1.0);
}

TEST(Functions, ExpLogAngleErfAndBesselAgreeWithTheLibrary) {
  for (int i = -3000; i <= 3000; ++i) {
    const double x = i * 0.0231;
    const auto e = static_cast<double>(std::exp(static_cast<long double>(x)));
    EXPECT_NEAR(natural_exp(x) / e, 1, 9e-16) << x;
    EXPECT_NEAR(natural_log(e), static_cast<double>(std::log(static_cast<long double>(e))), 4e-16 * (1 + std::abs(x)));
    EXPECT_NEAR(error_function(x / 12), std::erf(x / 12), 2e-15) << x;
    const double y = 3 * std::sin(i * 1.7);
    EXPECT_NEAR(angle_of(y, x), std::atan2(y, x), 9e-16);
  }
  EXPECT_EQ(angle_of(0, 0), 0.0);
  constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [y, x] : {std::pair{infinity, infinity}, {infinity, -infinity}, {nan, 1.0}, {1.0, nan}})
    EXPECT_EQ(angle_of(y, x), 0.0);
  EXPECT_EQ(natural_exp(0), 1.0);
  EXPECT_EQ(natural_exp(-1000), 0.0);
  EXPECT_EQ(natural_log(1), 0.0);
  EXPECT_EQ(sinc(0), 1.0);
  EXPECT_NEAR(natural_log(4.9e-324), std::log(4.9e-324), 1e-12);
  for (double x : {0.0, 0.5, 2.0, 8.6, 14.0, 60.0})
    EXPECT_NEAR(bessel_i0(x) / std::cyl_bessel_i(0.0, x), 1, 1e-14) << x;
}

}  // namespace
}  // namespace zoneplate
