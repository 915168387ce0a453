// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "zoneplate/math/elementary_constants.h"

namespace zoneplate {

/// The elementary functions in float, with the same bits on every machine, compiler and instruction set.
///
/// They use only + - * / √, comparisons, conversions and bit operations; math/elementary_simd.h has the same functions
/// for vectors. Errors are in units in the last place of the result (one ulp is 2^-23 of the power of two below it),
/// measured relative to long double over the whole range (checked by elementary_test.cpp).
///
/// Requires  arguments are finite, unless stated otherwise.

namespace elementary {

/// The integer nearest to x, ties to even; |x| < 2^22.
constexpr std::int32_t nearest(float x) { return std::bit_cast<std::int32_t>(x + round_shift) - round_shift_bits; }

/// value × 2^k by adding to the exponent bits; value and result must be normal.
constexpr float scaled(float value, std::int32_t k) {
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(value) + k * (1 << 23));
}

/// The decomposition x = m × 2^e with m in [√½, √2), and s = (m - 1) / (m + 1).
struct Log {
  float e, s;
};
constexpr Log split_log(float x) {
  const std::int32_t bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t e = (bits - root_half_bits) >> 23;
  const float d = std::bit_cast<float>(bits - e * (1 << 23)) - 1;
  return {static_cast<float>(e), d / (d + 2)};
}

/// The decomposition x = quarter × π/2 + r with |r| <= π/4.
struct Angle {
  std::int32_t quarter;
  float r;
};
constexpr Angle split_angle(float x) {
  x = x > -max_angle ? x : -max_angle;
  x = x < max_angle ? x : max_angle;
  const std::int32_t quarter = nearest(x * two_over_pi);
  const float k = static_cast<float>(quarter);
  x = x - k * half_pi_parts[0];
  x = x - k * half_pi_parts[1];
  x = x - k * half_pi_parts[2];
  return {quarter, x - k * half_pi_parts[3]};
}

constexpr float sin_reduced(float r) {
  const float z = r * r;
  return r + r * (z * (sin_c[0] + z * (sin_c[1] + z * sin_c[2])));
}
constexpr float cos_reduced(float r) {
  const float z = r * r;
  return (1 - 0.5f * z) + (z * z) * (cos_c[0] + z * (cos_c[1] + z * cos_c[2]));
}

/// sin(quarter × π/2 + r).
constexpr float sin_quarter(std::int32_t quarter, float r) {
  const float v = quarter & 1 ? cos_reduced(r) : sin_reduced(r);
  return quarter & 2 ? -v : v;
}

}  // namespace elementary

/// 2^x. Edges: 0 below -126, infinity from 128 on. Exact: within 1.5 ulp.
constexpr float exp2(float x) {
  using namespace elementary;
  if (!(x >= exp2_low)) return 0;
  if (x >= exp2_high) return std::bit_cast<float>(0x7f800000);
  const std::int32_t k = nearest(x);
  const float f = x - static_cast<float>(k);
  const float f2 = f * f;
  const float low = exp2_c[0] + exp2_c[1] * f;
  const float middle = exp2_c[2] + exp2_c[3] * f;
  const float high = exp2_c[4] + exp2_c[5] * f;
  return scaled(1 + f * (low + f2 * (middle + f2 * high)), k);
}

/// e^x. Edges: 0 below -87.3365, infinity from 88.7228 on. Exact: within 1 ulp.
constexpr float exp(float x) {
  using namespace elementary;
  if (!(x >= exp_low)) return 0;
  if (x >= exp_high) return std::bit_cast<float>(0x7f800000);
  const std::int32_t k = nearest(x * log2_e);
  const float n = static_cast<float>(k);
  const float r = (x - n * ln2_head) - n * ln2_tail;
  const float r2 = r * r;
  const float low = exp_c[0] + exp_c[1] * r;
  const float middle = exp_c[2] + exp_c[3] * r;
  return scaled(1 + (r + r2 * (low + r2 * (middle + r2 * exp_c[4]))), k);
}

/// The logarithm to base 2. Edges: -infinity below 2^-126, including negative x; 128 for infinity. Exact: within 3 ulp.
constexpr float log2(float x) {
  using namespace elementary;
  if (!(x >= min_normal)) return std::bit_cast<float>(0xff800000);
  const Log l = split_log(x);
  const float z = l.s * l.s;
  const float tail = two_log2_e_tail + z * (log2_c[0] + z * (log2_c[1] + z * log2_c[2]));
  return l.e + (l.s * two_log2_e_head + l.s * tail);
}

/// The logarithm to base 2 with four digits. Requires: x normal, positive. Exact: within 1/3000; exact at powers of
/// two.
constexpr float coarse_log2(float x) {
  using namespace elementary;
  const std::int32_t bits = std::bit_cast<std::int32_t>(x);
  const float e = static_cast<float>((bits >> 23) - 127);
  const float t = std::bit_cast<float>((bits & 0x7fffff) | 0x3f800000) - 1;
  const float q = (coarse_log2_c[0] + t * coarse_log2_c[1]) + (t * t) * coarse_log2_c[2];
  return e + (t + (t * (t - 1)) * q);
}

/// The natural logarithm. Edges: as for log2. Exact: within 3 ulp.
constexpr float log(float x) {
  using namespace elementary;
  if (!(x >= min_normal)) return std::bit_cast<float>(0xff800000);
  const Log l = split_log(x);
  const float z = l.s * l.s;
  const float tail = l.e * ln2_tail + l.s * (z * (log_c[0] + z * (log_c[1] + z * log_c[2])));
  return l.e * ln2_head + (2 * l.s + tail);
}

/// x^y = 2^(y log2 x) for x >= 0.
///
/// Edges     pow(x, 0) = 1; x below 2^-126 (including negative x) counts as 0: 0 for y > 0, infinity for y < 0.
/// Exact     relative error within (1 + 2 |y log2 x|) 2^-23; within 2^-20 if 2^-3 <= x^y <= 2^3.
constexpr float pow(float x, float y) { return y == 0 ? 1.0f : exp2(y * log2(x)); }

/// The sine of x radians.
///
/// Edges     |x| above 2^20 is replaced by 2^20; sin(-0) is +0.
/// Exact     within the greater of 2 ulp and 2^-24 for |x| <= 8192; beyond, as if x had an error of 2^-22 x.
constexpr float sin(float x) {
  const elementary::Angle a = elementary::split_angle(x);
  return elementary::sin_quarter(a.quarter, a.r);
}

/// The cosine of x radians; edges and errors as for sin.
constexpr float cos(float x) {
  const elementary::Angle a = elementary::split_angle(x);
  return elementary::sin_quarter(a.quarter + 1, a.r);
}

/// The angle of (x, y) from the x axis, in [-π, π]; the signs of zeros have the same effect as in the C library.
///
/// Requires  |x|, |y| <= 2^126.
/// Edges     atan2(±0, +0) = ±0; atan2(±0, -0) = ±π.
/// Exact     within 3 ulp.
inline float atan2(float y, float x) {
  using namespace elementary;
  // Reduces to the first octant, and by a rotation by π/4 to half of it.
  const float ax = std::abs(x), ay = std::abs(y);
  const bool is_steep = ay > ax;
  const float a = is_steep ? ax : ay, b = is_steep ? ay : ax;
  const bool is_turned = a > tan_eighth_pi * b;
  const float above = is_turned ? a - b : a, below = is_turned ? a + b : b;
  const float t = below > 0 ? above / below : 0.0f;
  const float z = t * t;
  const float odd = atan_c[0] + z * (atan_c[1] + z * (atan_c[2] + z * (atan_c[3] + z * atan_c[4])));
  const float octant = (is_turned ? quarter_pi : 0.0f) + (t + t * (z * odd));
  const float quadrant = is_steep ? half_pi - octant : octant;
  return std::copysign(std::signbit(x) ? pi - quadrant : quadrant, y);
}

/// The angle in [0, π] with cosine x. Edges: x is clamped to [-1, 1]. Exact: within 3 ulp.
inline float acos(float x) {
  x = x > -1 ? x : -1.0f;
  x = x < 1 ? x : 1.0f;
  return atan2(std::sqrt((1 - x) * (1 + x)), x);
}

/// The angle in [-π/2, π/2] with sine x. Edges: x is clamped to [-1, 1]. Exact: within 3 ulp.
inline float asin(float x) {
  x = x > -1 ? x : -1.0f;
  x = x < 1 ? x : 1.0f;
  return atan2(x, std::sqrt((1 - x) * (1 + x)));
}

}  // namespace zoneplate
