// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The coefficients of math/elementary.h and its vector equivalent, in ascending order of power.
///
/// Polynomials are minimax fits over the reduced ranges, rounded to float; the error of each before rounding is below
/// 2^-28. Constants that are subtracted in parts end in zero bits, so that their products with the quotient are exact.
namespace zoneplate::elementary {

/// Adding it to x, |x| < 2^22, leaves the integer nearest to x in the low bits of the sum.
inline constexpr float round_shift = 0x1.8p23f;
inline constexpr int round_shift_bits = 0x4b400000;

/// (2^f - 1) / f, |f| <= 1/2.
inline constexpr float exp2_c[6] = {0x1.62e430p-1f, 0x1.ebfbdcp-3f,  0x1.c6aee8p-5f,
                                    0x1.3b2d4cp-7f, 0x1.5f3e54p-10f, 0x1.41fbb8p-13f};
inline constexpr float exp2_low = -126;
inline constexpr float exp2_high = 128;

/// (e^r - 1 - r) / r^2, |r| <= ln 2 / 2.
inline constexpr float exp_c[5] = {0x1.fffffcp-2f, 0x1.555492p-3f, 0x1.5558f2p-5f, 0x1.1239d4p-7f, 0x1.6a2444p-10f};
inline constexpr float exp_low = -87.3365f;
inline constexpr float exp_high = 88.7228f;
inline constexpr float log2_e = 0x1.715476p+0f;
inline constexpr float ln2_head = 0x1.62e0p-1f;
inline constexpr float ln2_tail = 0x1.0bfbe8p-15f;

/// With s = (m - 1) / (m + 1): (log m - 2 s) / s^3 and (log2 m - 2 s log2 e) / s^3, in powers of s^2.
inline constexpr float log_c[3] = {0x1.55557ap-1f, 0x1.995ebap-2f, 0x1.31e2f6p-2f};
inline constexpr float log2_c[3] = {0x1.ec70d2p-1f, 0x1.274c4ep-1f, 0x1.b94d12p-2f};
/// (log2 m - t) / (t (t - 1)) with t = m - 1 in [0, 1], in powers of t.
inline constexpr float coarse_log2_c[3] = {-0x1.c35c0ap-2f, 0x1.f0fcb0p-3f, -0x1.4e4c50p-4f};
inline constexpr float two_log2_e_head = 0x1.7140p+1f;
inline constexpr float two_log2_e_tail = 0x1.47652cp-11f;
inline constexpr float min_normal = 0x1p-126f;
/// The bits of the float just below √½, the lower end of the range [√½, √2) of mantissas.
inline constexpr int root_half_bits = 0x3f3504f3;

/// (sin r - r) / r^3 and (cos r - 1 + r^2 / 2) / r^4 in powers of r^2, |r| <= π/4.
inline constexpr float sin_c[3] = {-0x1.555546p-3f, 0x1.110760p-7f, -0x1.994eb0p-13f};
inline constexpr float cos_c[3] = {0x1.55554ap-5f, -0x1.6c0c8cp-10f, 0x1.9a0252p-16f};
inline constexpr float two_over_pi = 0x1.45f306p-1f;
inline constexpr float half_pi_parts[4] = {0x1.92p+0f, 0x1.fb4p-12f, 0x1.444p-24f, 0x1.68c234p-39f};
inline constexpr float max_angle = 0x1p20f;

/// (atan t - t) / t^3 in powers of t^2, |t| <= tan(π/8).
inline constexpr float atan_c[5] = {-0x1.55554ap-2f, 0x1.9991aep-3f, -0x1.23b6c8p-3f, 0x1.b2030cp-4f, -0x1.f25ae4p-5f};
inline constexpr float tan_eighth_pi = 0x1.a8279ap-2f;
inline constexpr float quarter_pi = 0x1.921fb6p-1f;
inline constexpr float half_pi = 0x1.921fb6p+0f;
inline constexpr float pi = 0x1.921fb6p+1f;

}  // namespace zoneplate::elementary
