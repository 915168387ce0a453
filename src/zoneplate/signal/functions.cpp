// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/functions.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace zoneplate {
namespace {

using std::numbers::pi;

/// c[0] + u (c[1] + u (c[2] + ...)), with the coefficients in descending order of power.
template <std::size_t n>
double polynomial(const double (&highest_first)[n], double u) {
  double sum = highest_first[0];
  for (std::size_t i = 1; i < n; ++i) sum = sum * u + highest_first[i];
  return sum;
}

// Taylor polynomials for |t| <= π/4; the first omitted term is below 1e-17.
constexpr double sine_terms[] = {1.0 / 355687428096000.0, -1.0 / 1307674368000.0, 1.0 / 6227020800.0, -1.0 / 39916800.0,
                                 1.0 / 362880.0,          -1.0 / 5040.0,          1.0 / 120.0,        -1.0 / 6.0};
constexpr double cosine_terms[] = {1.0 / 20922789888000.0, -1.0 / 87178291200.0, 1.0 / 479001600.0, -1.0 / 3628800.0,
                                   1.0 / 40320.0,          -1.0 / 720.0,         1.0 / 24.0};

double small_sin(double t) {
  const double u = t * t;
  return t + t * (u * polynomial(sine_terms, u));
}

double small_cos(double t) {
  const double u = t * t;
  return 1 - (0.5 * u - u * u * polynomial(cosine_terms, u));
}

/// The sine and cosine at angle quadrant · π/2 + t, for |t| <= π/4.
SineCosine turned(std::uint64_t quadrant, double t) { return turned(quadrant, SineCosine{small_sin(t), small_cos(t)}); }

constexpr double ln2_high = 0x1.62e42fefa0000p-1;  // ln 2 to 33 bits, so that k · ln2_high is exact
constexpr double ln2_low = 0x1.cf79abc9e3b39p-40;

}  // namespace

SineCosine sin_cos_pi(double x) {
  // Computed from |x|, so that the sine is exactly odd and the cosine exactly even.
  const double a = std::abs(x);
  if (!(a < 0x1p52)) return {0, 1};
  const double quarter = std::floor(2 * a + 0.5);
  const SineCosine p = turned(static_cast<std::uint64_t>(quarter), pi * (a - 0.5 * quarter));
  return {x < 0 ? -p.sine : p.sine, p.cosine};
}

double sin_pi(double x) { return sin_cos_pi(x).sine; }
double cos_pi(double x) { return sin_cos_pi(x).cosine; }

SineCosine unit_root(std::uint64_t k, std::uint64_t n) {
  assert(k < n && n < (std::uint64_t{1} << 60));
  // The angle is (quadrant + r / n) · π/2 with |r| <= n / 2.
  const std::uint64_t quadrant = (4 * k + n / 2) / n;
  const std::int64_t r = static_cast<std::int64_t>(4 * k) - static_cast<std::int64_t>(quadrant * n);
  return turned(quadrant, pi / 2 * (static_cast<double>(r) / static_cast<double>(n)));
}

double sinc(double x) { return x == 0 ? 1 : sin_pi(x) / (pi * x); }

double natural_exp(double x) {
  if (!(x >= -708)) return 0;
  if (x > 709) return std::numeric_limits<double>::infinity();
  // e^x = 2^k e^r with |r| <= ln 2 / 2.
  const double k = std::floor(x * (1 / (ln2_high + ln2_low)) + 0.5);
  const double r = (x - k * ln2_high) - k * ln2_low;
  double e = 1;
  for (int i = 14; i >= 1; --i) e = 1 + e * (r / i);
  // 2^k is the product of two factors, because 2^1024 itself would overflow.
  const int half = static_cast<int>(k) / 2, rest = static_cast<int>(k) - half;
  const auto power = [](int p) { return std::bit_cast<double>(static_cast<std::uint64_t>(p + 1023) << 52); };
  return e * power(half) * power(rest);
}

double natural_log(double x) {
  assert(x > 0 && x <= std::numeric_limits<double>::max());
  // x = 2^k m with m in [√½, √2).
  int k = 0;
  if (x < 0x1p-1022) x *= 0x1p60, k = -60;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  k += static_cast<int>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffu) | 0x3ff0000000000000u);
  if (m > 1.4142135623730951) m *= 0.5, ++k;

  // ln m = 2 artanh(s), s = (m - 1) / (m + 1), |s| < 0.172.
  const double s = (m - 1) / (m + 1), u = s * s;
  double tail = 1.0 / 23;
  for (int i = 21; i >= 3; i -= 2) tail = tail * u + 1.0 / i;
  return k * ln2_high + (2 * s + (2 * s * (u * tail) + k * ln2_low));
}

double angle_of(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y);
  if (ax == 0 && ay == 0) return 0;
  // In the first octant: t = low / high in [0, 1]; atan t = atan c + atan((t - c) / (1 + t c)), where c is t rounded to
  // a quarter.
  const double low = ax < ay ? ax : ay, high = ax < ay ? ay : ax;
  const double t = low / high;
  if (!(t <= 1)) return 0;
  static constexpr double atan_quarter[] = {0, 0.24497866312686414, 0.46364760900080609, 0.64350110879328437, pi / 4};
  const int q = static_cast<int>(4 * t + 0.5);
  const double c = q * 0.25;
  const double d = (t - c) / (1 + t * c), u = d * d;
  double tail = 1.0 / 19;
  for (int i = 17; i >= 3; i -= 2) tail = 1.0 / i - tail * u;
  double angle = atan_quarter[q] + (d - d * u * tail);
  if (ay > ax) angle = pi / 2 - angle;
  if (x < 0) angle = pi - angle;
  return y < 0 ? -angle : angle;
}

double error_function(double x) {
  const double a = std::abs(x);
  if (!(a < 6)) return x < 0 ? -1 : 1;
  // erf x = 2/√π e^(-x²) Σ 2^k x^(2k+1) / (1 · 3 ··· (2k+1)): every term is positive, so that there is no cancellation.
  double term = a, sum = a;
  for (int k = 1; k < 200 && term > sum * 0x1p-60; ++k) {
    term *= 2 * a * a / (2 * k + 1);
    sum += term;
  }
  const double two_over_root_pi = 1.1283791670955126;
  const double e = two_over_root_pi * natural_exp(-a * a) * sum;
  return x < 0 ? -e : e;
}

double bessel_i0(double x) {
  assert(std::abs(x) <= 100);
  const double quarter = x * x / 4;
  double term = 1, sum = 1;
  for (int k = 1; k < 400 && term > sum * 0x1p-60; ++k) {
    term *= quarter / (static_cast<double>(k) * k);
    sum += term;
  }
  return sum;
}

}  // namespace zoneplate
