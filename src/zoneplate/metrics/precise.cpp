#include "zoneplate/metrics/precise.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace zoneplate::metrics {
namespace {

// ln 2 in two parts; the head has 21 trailing zero bits, so that k × head is exact for every exponent k.
constexpr double ln2_head = 0x1.62e42feep-1;
constexpr double ln2_tail = 0x1.a39ef35793c76p-33;

/// 1 / n! for n = 0, 1, 2, ...
constexpr std::array<double, 18> inverse_factorials = [] {
  std::array<double, 18> inverse{};
  double factorial = 1;
  for (std::size_t n = 0; n < inverse.size(); ++n) {
    if (n > 0) factorial *= static_cast<double>(n);
    inverse[n] = 1 / factorial;
  }
  return inverse;
}();

/// 1/3, 1/5, 1/7, ...: the series of artanh after its first term.
constexpr std::array<double, 11> odd_inverses = [] {
  std::array<double, 11> inverse{};
  for (std::size_t i = 0; i < inverse.size(); ++i) inverse[i] = 1 / static_cast<double>(2 * i + 3);
  return inverse;
}();

double power_of_two(std::int64_t k) { return std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52); }

/// Taylor's series of cos(2πt) for |t| <= 1/8.
double cos_small(double t) {
  const double z = (2 * pi * t) * (2 * pi * t);
  double sum = inverse_factorials[16];
  for (int n = 14; n >= 0; n -= 2) sum = inverse_factorials[static_cast<std::size_t>(n)] - z * sum;
  return sum;
}

/// Taylor's series of sin(2πt) for |t| <= 1/8.
double sin_small(double t) {
  const double x = 2 * pi * t, z = x * x;
  double sum = inverse_factorials[17];
  for (int n = 15; n >= 1; n -= 2) sum = inverse_factorials[static_cast<std::size_t>(n)] - z * sum;
  return x * sum;
}

}  // namespace

double precise_log(double x) {
  // x = m 2^e with m in [√½, √2).
  constexpr std::uint64_t root_half = 0x3fe6a09e667f3bcd;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  const std::int64_t e = static_cast<std::int64_t>(bits - root_half) >> 52;
  const double m = std::bit_cast<double>(bits - (static_cast<std::uint64_t>(e) << 52));

  // ln m = 2 artanh(s), s = (m - 1) / (m + 1), |s| < 0.172: the first term left out is below 1e-18 of the sum.
  const double s = (m - 1) / (m + 1), z = s * s;
  double series = 0;
  for (std::size_t i = odd_inverses.size(); i > 0; --i) series = z * (odd_inverses[i - 1] + series);
  const double k = static_cast<double>(e);
  return k * ln2_head + (2 * s + (2 * s * series + k * ln2_tail));
}

double precise_exp(double x) {
  if (!(x >= -700)) return 0;
  if (x > 700) return std::numeric_limits<double>::infinity();
  const double k = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = (x - k * ln2_head) - k * ln2_tail;
  double sum = inverse_factorials[15];
  for (std::size_t n = 15; n > 0; --n) sum = inverse_factorials[n - 1] + r * sum;
  return sum * power_of_two(static_cast<std::int64_t>(k));
}

double precise_power(double x, double y) { return x > 0 ? precise_exp(y * precise_log(x)) : 0; }

double precise_cube_root(double x) {
  if (!(x > 0)) return 0;
  // A third of the exponent and a chord for the fraction start within 6 %; Halley's step triples the digits.
  constexpr std::uint64_t third_of_bias = 0x2a9f7893782da1ce;
  double root = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + third_of_bias);
  for (int step = 0; step < 3; ++step) {
    const double cube = root * root * root;
    root = root * ((cube + 2 * x) / (2 * cube + x));
  }
  return root;
}

double cos_turns(double turns) {
  const double t = turns - std::floor(turns + 0.5);
  const double a = std::abs(t);
  if (a <= 0.125) return cos_small(a);
  if (a <= 0.375) return sin_small(0.25 - a);
  return -cos_small(0.5 - a);
}

double precise_log10(double x) {
  if (!(x > 0)) return -std::numeric_limits<double>::infinity();
  if (std::isinf(x)) return x;
  return precise_log(x) * 0.43429448190325182765;
}

double sinc(double x) { return x == 0 ? 1 : cos_turns(x / 2 - 0.25) / (pi * x); }

}  // namespace zoneplate::metrics
