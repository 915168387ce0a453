#pragma once

namespace zoneplate::metrics {

/// Elementary functions in double, with the same bits on every machine and compiler: scores are compared to the
/// last digit, and the C library's functions differ. Made of + - * / √, comparisons, conversions and bits only.
///
/// Exact     within 4e-16 of the value (relative; for cos_turns absolute); power: within 2e-16 (2 + |y ln x|).

/// Requires  x > 0, finite and normal.
double precise_log(double x);

/// Edges     0 below -700, infinity above 700.
double precise_exp(double x);

/// x to the power of y. Edges: 0 for x <= 0.
double precise_power(double x, double y);

/// The cube root of x >= 0.
double precise_cube_root(double x);

/// cos(2π turns). Requires |turns| < 2^50.
double cos_turns(double turns);

/// log10(x). Edges: -infinity for x <= 0; infinity at infinity.
double precise_log10(double x);

constexpr double pi = 3.141592653589793238462643;

/// sin(πx) / (πx), the response of a box one sample wide; 1 at 0.
double sinc(double x);

}  // namespace zoneplate::metrics
