// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/elementary.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/elementary_rows.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// |value - truth| in units in the last place of the float nearest to the exact value.
double ulps(float value, long double truth) {
  int exponent = 0;
  std::frexp(static_cast<double>(truth), &exponent);
  const int least = std::max(exponent - 24, -149);
  return static_cast<double>(std::abs(static_cast<long double>(value) - truth) / std::ldexp(1.0L, least));
}

/// Evenly spaced numbers in [low, high], including both ends.
std::vector<float> spread(float low, float high, int count) {
  std::vector<float> values;
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    values.push_back(static_cast<float>(static_cast<double>(low) * (1 - t) + static_cast<double>(high) * t));
  }
  return values;
}

/// Positive normal numbers with all exponents.
std::vector<float> positive(std::uint32_t count, std::uint32_t seed) {
  std::vector<float> values;
  for (std::uint32_t i = 0; i < count; ++i) {
    values.push_back(std::bit_cast<float>(0x00800000u + hash(i, seed) % (0x7f000000u - 0x00800000u)));
  }
  return values;
}

template <class Function, class Truth>
double worst_ulps(const std::vector<float>& values, Function function, Truth truth) {
  double worst = 0;
  for (const float x : values) worst = std::max(worst, ulps(function(x), truth(static_cast<long double>(x))));
  return worst;
}

TEST(Elementary, Exp2IsWithinOneAndAHalfUlp) {
  const auto truth = [](long double x) { return std::exp2(x); };
  EXPECT_LT(worst_ulps(
                spread(-126, 127.999f, 200000), [](float x) { return exp2(x); }, truth),
            1.5);
  EXPECT_LT(worst_ulps(
                spread(-1, 1, 100000), [](float x) { return exp2(x); }, truth),
            1.5);
  for (int k = -126; k < 128; ++k) EXPECT_EQ(exp2(static_cast<float>(k)), std::ldexp(1.0f, k));
  EXPECT_EQ(exp2(-126.001f), 0);
  EXPECT_EQ(exp2(-infinity), 0);
  EXPECT_EQ(exp2(128), infinity);
  EXPECT_LT(exp2(std::nextafter(128.0f, 0.0f)), infinity);
}

TEST(Elementary, ExpIsWithinOneUlp) {
  const auto truth = [](long double x) { return std::exp(x); };
  EXPECT_LT(worst_ulps(
                spread(-87.336f, 88.722f, 200000), [](float x) { return exp(x); }, truth),
            1);
  EXPECT_LT(worst_ulps(
                spread(-1, 1, 100000), [](float x) { return exp(x); }, truth),
            1);
  EXPECT_EQ(exp(0), 1);
  EXPECT_EQ(exp(-88), 0);
  EXPECT_EQ(exp(89), infinity);
}

TEST(Elementary, LogarithmsAreWithinThreeUlp) {
  const auto truth2 = [](long double x) { return std::log2(x); };
  const auto truth = [](long double x) { return std::log(x); };
  for (const auto& values : {positive(200000, 1), spread(0.5f, 2, 200000), spread(0.999f, 1.001f, 100000)}) {
    EXPECT_LT(worst_ulps(
                  values, [](float x) { return log2(x); }, truth2),
              3);
    EXPECT_LT(worst_ulps(
                  values, [](float x) { return log(x); }, truth),
              3);
  }
  for (int k = -126; k < 128; ++k) EXPECT_EQ(coarse_log2(std::ldexp(1.0f, k)), static_cast<float>(k));
  for (float x = 0.25f; x < 4; x *= 1.0003f) ASSERT_NEAR(coarse_log2(x), std::log2(x), 1.0 / 3000);
  for (int k = -126; k < 128; ++k) EXPECT_EQ(log2(std::ldexp(1.0f, k)), static_cast<float>(k));
  EXPECT_EQ(log(1), 0);
  for (const float x : {0.0f, -0.0f, -1.0f, 1e-40f}) {
    EXPECT_EQ(log2(x), -infinity);
    EXPECT_EQ(log(x), -infinity);
  }
}

TEST(Elementary, PowKeepsItsRelativeError) {
  double worst_share = 0, worst_near_one = 0;
  const std::vector<float> bases = positive(200000, 2);
  for (std::uint32_t i = 0; i < bases.size(); ++i) {
    const float x = i % 2 == 0 ? bases[i] : unit_float(hash(i, 3)) + 0x1p-24f;
    const float y = (unit_float(hash(i, 4)) - 0.5f) * (i % 4 < 2 ? 8.0f : 1000.0f);
    const long double expected = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    const double size = std::abs(static_cast<double>(std::log2(expected)));
    if (size > 125) continue;
    const double error = static_cast<double>(std::abs(static_cast<long double>(pow(x, y)) / expected - 1));
    worst_share = std::max(worst_share, error * 0x1p23 / (1 + 2 * size));
    if (size <= 3) worst_near_one = std::max(worst_near_one, error);
  }
  EXPECT_LT(worst_share, 1);
  EXPECT_LT(worst_near_one, 0x1p-20);
}

TEST(Elementary, PowHasItsEdges) {
  for (const float x : {0.0f, 0.5f, 1.0f, 1e30f}) EXPECT_EQ(pow(x, 0), 1);
  for (const float y : {0.1f, 1.0f, 2.4f, 1000.0f}) EXPECT_EQ(pow(0, y), 0);
  EXPECT_EQ(pow(0, -1), infinity);
  EXPECT_EQ(pow(1, 1234.5f), 1);
  EXPECT_EQ(pow(2, 10), 1024);
  static_assert(pow(4.0f, 0.5f) == 2.0f);
}

TEST(Elementary, SinAndCosKeepTheirErrors) {
  const auto worst = [](float low, float high) {
    double most = 0;
    for (const float x : spread(low, high, 200000)) {
      const long double s = std::sin(static_cast<long double>(x)), c = std::cos(static_cast<long double>(x));
      const auto error = [](float value, long double truth) {
        return std::min(ulps(value, truth) / 2, std::abs(static_cast<double>(value - truth)) * 0x1p24);
      };
      most = std::max({most, error(sin(x), s), error(cos(x), c)});
    }
    return most;
  };
  EXPECT_LT(worst(-4, 4), 1);
  EXPECT_LT(worst(-8192, 8192), 1);
  EXPECT_EQ(sin(0), 0);
  EXPECT_EQ(cos(0), 1);
  EXPECT_EQ(sin(0x1p21f), sin(0x1p20f));
  for (const float x : spread(0x1p13f, 0x1p20f, 10000)) EXPECT_LE(std::abs(sin(x)), 1);
}

TEST(Elementary, Atan2IsWithinThreeUlp) {
  double worst = 0;
  for (std::uint32_t i = 0; i < 200000; ++i) {
    const auto coordinate = [&](std::uint32_t dimension) {
      const float magnitude = exp2((unit_float(hash(i, 5, dimension)) - 0.5f) * (i % 2 == 0 ? 4.0f : 60.0f));
      return hash(i, 6, dimension) % 2 == 0 ? magnitude : -magnitude;
    };
    const float y = coordinate(0), x = coordinate(1);
    worst = std::max(worst, ulps(atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))));
  }
  EXPECT_LT(worst, 3);
  for (const float y : {0.0f, -0.0f, 1.0f, -1.0f}) {
    for (const float x : {0.0f, -0.0f, 1.0f, -1.0f}) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(atan2(y, x)), std::bit_cast<std::uint32_t>(std::atan2(y, x)))
          << y << ' ' << x;
    }
  }
}

TEST(Elementary, ArcFunctionsAreWithinThreeUlp) {
  for (const auto& values : {spread(-1, 1, 100000), spread(0.9999f, 1, 10000), spread(-1e-3f, 1e-3f, 9999)}) {
    EXPECT_LT(worst_ulps(
                  values, [](float x) { return acos(x); }, [](long double x) { return std::acos(x); }),
              3);
    EXPECT_LT(worst_ulps(
                  values, [](float x) { return asin(x); }, [](long double x) { return std::asin(x); }),
              3);
  }
  EXPECT_EQ(acos(1.5f), 0);
  EXPECT_EQ(acos(-1.5f), elementary::pi);
  EXPECT_EQ(asin(1), elementary::half_pi);
}

/// Arguments for every branch: all magnitudes and signs, integers, halves and the ends of the ranges.
std::vector<float> arguments(std::uint32_t seed) {
  std::vector<float> values = {0.0f, -0.0f,     1,         -1,       0.5f,   -126, -126.001f,
                               128,  127.9999f, -87.3365f, 88.7228f, 1e-40f, 1e38f};
  values.insert(values.end(), {infinity, -infinity, std::numeric_limits<float>::quiet_NaN(), 0x1p20f, -0x1p20f, 3e38f});
  for (std::uint32_t i = 0; i < 50000; ++i) {
    const float unit = unit_float(hash(i, seed)) * 2 - 1;
    values.insert(values.end(), {unit, unit * 100, unit * 8192, std::bit_cast<float>(hash(i, seed, 1) & 0xff7fffffu)});
  }
  return values;
}

TEST(Elementary, EveryInstructionSetGivesTheSameBits) {
  const std::vector<float> a = arguments(7);
  std::vector<float> b = arguments(8);
  std::swap(b.front(), b.back());
  for (const Isa isa : supported_isas()) {
    const ElementaryKernels& kernels = ElementaryKernels::of(isa);
    for (int f = 0; f <= static_cast<int>(Elementary::Asin); ++f) {
      const auto function = static_cast<Elementary>(f);
      std::vector<float> expected(a.size()), found(a.size());
      ElementaryKernels::scalar.evaluate(function, a.data(), b.data(), expected.data(), a.size());
      kernels.evaluate(function, a.data(), b.data(), found.data(), a.size());
      std::size_t different = 0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        const bool is_same = std::bit_cast<std::uint32_t>(expected[i]) == std::bit_cast<std::uint32_t>(found[i]);
        if (!is_same && !(std::isnan(expected[i]) && std::isnan(found[i])) && different++ < 5) {
          ADD_FAILURE() << name_of(isa) << " function " << f << " of " << a[i] << ", " << b[i] << ": " << found[i]
                        << ", expected " << expected[i];
        }
      }
      EXPECT_EQ(different, 0u);
    }
  }
}

}  // namespace
}  // namespace zoneplate
