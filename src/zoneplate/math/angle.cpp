// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/angle.h"

#include <cmath>

namespace zoneplate {

SineCosine sine_cosine(double angle) {
  // Subtracts quarter turns until at most π/4 remains; π/2 is stored in two parts for additional precision.
  constexpr double half_pi_head = 0x1.921fb54442d18p+0, half_pi_tail = 0x1.1a62633145c07p-54;
  const double quarters = std::floor(angle / half_pi_head + 0.5);
  const double x = (angle - quarters * half_pi_head) - quarters * half_pi_tail;

  // Horner's scheme for the power series; the first omitted term is below 2^-60 for |x| <= π/4.
  const double z = x * x;
  double s = 1, c = 1;
  for (int n = 18; n >= 2; n -= 2) {
    s = 1 - z * s / (n * (n + 1));
    c = 1 - z * c / ((n - 1) * n);
  }
  return turned(static_cast<std::uint64_t>(static_cast<std::int64_t>(quarters)), {x * s, c});
}

}  // namespace zoneplate
