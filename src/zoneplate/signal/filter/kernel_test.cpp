// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/kernel.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

const long double pi_l = std::acos(-1.0L);
double as_double(long double x) { return static_cast<double>(x); }

std::vector<std::string> names() {
  return {"box",
          "box:width=3",
          "tent",
          "tent:radius=2",
          "gaussian:sigma=0.5",
          "gaussian:sigma=2,extent=3",
          "mitchell",
          "mitchell:b=0.7,c=-0.4",
          "catmull-rom",
          "b-spline",
          "lanczos2",
          "lanczos3",
          "lanczos:lobes=5",
          "blackman-harris",
          "blackman-harris:radius=1.5",
          "kaiser",
          "kaiser:radius=4,beta=9"};
}

class KernelOf : public testing::TestWithParam<std::string> {};

// Simpson's rule in long double on pieces between half-integers, within which all kernels are smooth except at the
// box's edge.
template <class F>
long double simpson(const F& f, long double a, long double b) {
  const int n = 64;
  const long double h = (b - a) / n;
  long double sum = f(a) + f(b);
  for (int i = 1; i < n; ++i) sum += (i % 2 ? 4 : 2) * f(a + h * i);
  return sum * h / 3;
}

template <class F>
long double integrate_pieces(const F& f, double radius) {
  long double sum = 0;
  // The ends are moved inwards slightly, so that a discontinuity at the radius is not halved.
  const int pieces = static_cast<int>(std::lround(16 * radius));
  for (int i = 0; i < pieces; ++i) {
    const long double a = static_cast<long double>(radius) * i / pieces;
    const long double b = static_cast<long double>(radius) * (i + 1) / pieces * (i + 1 == pieces ? 1 - 1e-15L : 1);
    sum += simpson(f, a, b);
  }
  return 2 * sum;
}

TEST_P(KernelOf, IsEvenAndZeroBeyondItsRadius) {
  const Kernel k = make_kernel(GetParam());
  for (double x : {0.1, 0.5, 0.77, 1.0, 1.4, 2.2}) EXPECT_EQ(k.value(x), k.value(-x));
  EXPECT_EQ(k.value(k.radius * 1.0001), 0.0);
  EXPECT_EQ(k.value(-100), 0.0);
  EXPECT_NE(k.value(k.radius * 0.99), 0.0);
}

TEST_P(KernelOf, IntegralAgreesWithNumericIntegration) {
  const Kernel k = make_kernel(GetParam());
  const auto value = [&](long double x) { return static_cast<long double>(k.value(as_double(x))); };
  const double total = as_double(integrate_pieces(value, k.radius));
  EXPECT_NEAR(k.integral(k.radius), total, 1e-10);
  EXPECT_EQ(k.integral(100), k.integral(k.radius));
  EXPECT_EQ(k.integral(-100), 0.0);
  EXPECT_NEAR(k.integral(0), total / 2, 1e-10);
  const bool is_windowed_sinc = GetParam().starts_with("lanczos") || GetParam().starts_with("kaiser");
  EXPECT_NEAR(total, 1, is_windowed_sinc ? 0.05 : 1e-10);
  // The derivative of the integral is the value.
  for (double x : {-1.3, -0.4, 0.2, 0.45, 1.1}) {
    const double h = 1e-4, slope = (k.integral(x + h) - k.integral(x - h)) / (2 * h);
    EXPECT_NEAR(slope, k.value(x), 1e-5) << x;
  }
}

TEST_P(KernelOf, ResponseAgreesWithNumericIntegration) {
  const Kernel k = make_kernel(GetParam());
  for (double f : {0.0, 0.01, 0.1, 0.124, 0.126, 0.25, 0.5, 0.75, 1.0, 1.37, 2.0, 3.3}) {
    const auto wave = [&](long double x) {
      return static_cast<long double>(k.value(as_double(x))) * std::cos(2 * pi_l * static_cast<long double>(f) * x);
    };
    EXPECT_NEAR(k.response(f), as_double(integrate_pieces(wave, k.radius)), 2e-9) << f;
    EXPECT_NEAR(k.response(f), k.response(-f), 1e-15);
  }
  EXPECT_NEAR(k.response(0), k.integral(k.radius), 1e-12);
}

TEST_P(KernelOf, PartitionOfUnityHoldsExactlyWhereItIsClaimed) {
  const Kernel k = make_kernel(GetParam());
  double worst = 0;
  for (int i = 0; i <= 40; ++i) {
    double sum = 0;
    for (int j = -12; j <= 12; ++j) sum += k.value(i / 40.0 - j);
    worst = std::max(worst, std::abs(sum - 1));
  }
  if (k.is_partition_of_unity)
    EXPECT_LT(worst, 1e-14);
  else
    EXPECT_GT(worst, 1e-12);
}

TEST_P(KernelOf, TapsSumToOneAndTheirResponseIsTheAliasedResponse) {
  const Kernel k = make_kernel(GetParam());
  const auto taps = sampled(k);
  double sum = 0, raw = 0;
  for (double t : taps) sum += t;
  for (int j = -20; j <= 20; ++j) raw += k.value(j);
  EXPECT_NEAR(sum, 1, 1e-15);
  EXPECT_EQ(taps.size() % 2, 1u);
  for (std::size_t i = 0; i < taps.size(); ++i) EXPECT_EQ(taps[i], taps[taps.size() - 1 - i]);
  EXPECT_NEAR(response_of_taps(taps, 0), 1, 1e-15);
  EXPECT_NEAR(response_of_taps(taps, 0.3), response_of_taps(taps, 1.3), 1e-14);
  // Poisson's summation formula: Σ k(j) cos(2πfj) = Σ_m response(f + m); the sum converges fast enough for smooth
  // kernels.
  if (GetParam() == "b-spline" || GetParam() == "mitchell") {
    double copies = 0;
    for (int m = -400; m <= 400; ++m) copies += k.response(0.2 + m);
    EXPECT_NEAR(response_of_taps(taps, 0.2) * raw, copies, 1e-7);
  }
}

TEST_P(KernelOf, StretchingKeepsTheIntegralAndScalesTheFrequency) {
  const Kernel k = make_kernel(GetParam());
  const Kernel wide = stretched(k, 2.5);
  EXPECT_DOUBLE_EQ(wide.radius, 2.5 * k.radius);
  EXPECT_DOUBLE_EQ(wide.value(0.6), k.value(0.24) / 2.5);
  EXPECT_NEAR(wide.response(0.1), k.response(0.25), 1e-15);
  EXPECT_EQ(wide.integral(1000), k.integral(1000));
}

INSTANTIATE_TEST_SUITE_P(Names, KernelOf, testing::ValuesIn(names()), [](const auto& test) {
  std::string name;
  for (char c : test.param) name += (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ? c : '_';
  return name;
});

TEST(Kernel, ValuesFromThePapers) {
  EXPECT_DOUBLE_EQ(make_kernel("mitchell").value(0), 16.0 / 18);
  EXPECT_DOUBLE_EQ(make_kernel("mitchell").value(1), 1.0 / 18);
  EXPECT_DOUBLE_EQ(make_kernel("catmull-rom").value(0.5), 0.5625);
  EXPECT_DOUBLE_EQ(make_kernel("catmull-rom").value(1.5), -0.0625);
  EXPECT_DOUBLE_EQ(make_kernel("b-spline").value(0), 2.0 / 3);
  EXPECT_DOUBLE_EQ(make_kernel("lanczos3").value(0.5), 2 / as_double(pi_l) * 0.95492965855137201461);
  EXPECT_EQ(make_kernel("lanczos2").value(1), 0.0);
  EXPECT_EQ(make_kernel("box").value(0.5), 0.5);
  EXPECT_NEAR(make_kernel("b-spline").response(0.5), std::pow(2 / as_double(pi_l), 4), 1e-14);
  // If it is truncated far outside, the Gaussian's transform is a Gaussian.
  EXPECT_NEAR(make_kernel("gaussian:sigma=2,extent=8").response(0.1), std::exp(-2 * 9.8696044010893586 * 0.04), 1e-14);
}

TEST(Kernel, TapsOfBoxesAreTheTrapezoidRule) {
  EXPECT_EQ(sampled(make_kernel("box")), (std::vector<double>{1}));
  EXPECT_EQ(sampled(make_kernel("box:width=2")), (std::vector<double>{0.25, 0.5, 0.25}));
  EXPECT_EQ(sampled(make_kernel("box:width=3")).size(), 3u);
  EXPECT_EQ(sampled(make_kernel("tent")), (std::vector<double>{1}));
  EXPECT_EQ(sampled(make_kernel("gaussian:sigma=8")).size(), 49u);
}

TEST(Kernel, EveryEntryOfTheListCanBeMadeAndNamesItsSource) {
  EXPECT_EQ(kernels().size(), 11u);
  for (const KernelEntry& entry : kernels()) {
    EXPECT_EQ(make_kernel(entry.name).name, entry.name);
    EXPECT_FALSE(entry.source.empty());
  }
  EXPECT_THROW(make_kernel("sombrero"), Error);
  EXPECT_THROW(make_kernel("gaussian:sigma=-1"), Error);
  EXPECT_THROW(make_kernel("lanczos3:lobes=2"), Error);
}

// All machines and compilers give the same bits: a hash of all kernels' values, integrals and responses.
TEST(Kernel, GivesTheBitsThatItAlwaysGave) {
  std::uint64_t bits = 14695981039346656037u;
  for (const KernelEntry& entry : kernels()) {
    const Kernel k = make_kernel(entry.name);
    for (int i = 0; i < 40; ++i) {
      const double x = i * 0.0871;
      for (const double v : {k.value(x), k.integral(x), k.response(x)})
        bits = (bits ^ std::bit_cast<std::uint64_t>(v)) * 1099511628211u;
    }
  }
  EXPECT_EQ(bits, 8927053200072031402u);
}

}  // namespace
}  // namespace zoneplate
