// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/math/angle.h"

namespace zoneplate {

/// Elementary functions in double precision for filters and transforms.
///
/// Exact     only + - × / √ and comparisons, in a fixed order: the same bits on every compiler and machine, which the C
///           library does not guarantee (its sin has variants per processor). Within 4 units in the last place of the
///           result unless a function states otherwise.

/// sin(πx) and cos(πx); exact zeros and ones at multiples of ½.
SineCosine sin_cos_pi(double x);
double sin_pi(double x);
double cos_pi(double x);

/// cos(2πk / n) and sin(2πk / n); the angle is reduced in integers, so that large k lose no precision.
///
/// Requires  0 <= k < n < 2^60.
SineCosine unit_root(std::uint64_t k, std::uint64_t n);

/// sin(πx) / (πx), 1 at 0.
double sinc(double x);

/// e^x; 0 below -708, infinity above 709.
double natural_exp(double x);

/// ln x for finite x > 0.
double natural_log(double x);

/// The angle of (x, y) in [-π, π]; 0 for (0, 0), if either is NaN, and if both are infinite.
double angle_of(double y, double x);

/// 2/√π ∫_0^x e^(-t²) dt. Within 2e-15.
double error_function(double x);

/// The modified Bessel function of the first kind of order 0, by its power series, for |x| <= 100.
double bessel_i0(double x);

}  // namespace zoneplate
