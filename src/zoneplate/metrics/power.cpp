// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/power.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

double extended_log(double x) {
  if (!(x > 0)) return -std::numeric_limits<double>::infinity();
  return std::isinf(x) ? x : natural_log(x);
}

}  // namespace

double power(double x, double y) { return x > 0 ? natural_exp(y * natural_log(x)) : 0; }

double cube_root(double x) {
  if (!(x > 0)) return 0;
  // A third of the bit pattern's exponent and fraction is within 6 % of the root; each step of Halley's method triples
  // the number of correct digits.
  constexpr std::uint64_t two_thirds_of_bias = 0x2a9f7893782da1ce;
  double root = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + two_thirds_of_bias);
  for (int step = 0; step < 3; ++step) {
    const double cube = root * root * root;
    root = root * ((cube + 2 * x) / (2 * cube + x));
  }
  return root;
}

double decimal_log(double x) { return extended_log(x) * std::numbers::log10e; }
double binary_log(double x) { return extended_log(x) * std::numbers::log2e; }

}  // namespace zoneplate::metrics
