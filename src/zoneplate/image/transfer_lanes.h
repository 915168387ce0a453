// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/image/transfer_rows.h"
#include "zoneplate/math/for_row.h"

/// The sRGB transfer curve and its kernels over a lane type of math/lanes.h.
namespace zoneplate {

/// The constants of the curve, IEC 61966-2-1: a line below the cutoff, an offset power above it.
namespace srgb {

inline constexpr float linear_cutoff = 0.0031308f;
inline constexpr float code_cutoff = 0.04045f;
inline constexpr float slope = 12.92f;
inline constexpr float scale = 1.055f;
inline constexpr float offset = scale - 1;  // computed, so that 1 is mapped exactly to 1
inline constexpr float power = 2.4f;
inline constexpr float inverse_power = 1 / 2.4f;

}  // namespace srgb

/// x clamped to [0, 1]; 0 for NaN.
template <class F>
[[gnu::always_inline]] inline F clamp_unit(F x) {
  return min(max(x, F(0.0f)), F(1.0f));
}

template <class F>
[[gnu::always_inline]] inline F encode_srgb(F linear) {
  const F x = clamp_unit(linear);
  const F curve = F(srgb::scale) * pow(x, F(srgb::inverse_power)) - F(srgb::offset);
  return select(x > F(srgb::linear_cutoff), curve, F(srgb::slope) * x);
}

template <class F>
[[gnu::always_inline]] inline F decode_srgb(F code) {
  const F x = clamp_unit(code);
  const F curve = pow((x + F(srgb::offset)) / F(srgb::scale), F(srgb::power));
  return select(x > F(srgb::code_cutoff), curve, x / F(srgb::slope));
}

namespace stages {

template <class Full, class One>
[[gnu::flatten]] void encode_row(const float* linear, float* code, std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) { encode_srgb(F::load(linear + i)).store(code + i); });
}

template <class Full, class One>
[[gnu::flatten]] void decode_row(const float* code, float* linear, std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) { decode_srgb(F::load(code + i)).store(linear + i); });
}

template <class Full, class One, class Code, int greatest>
[[gnu::flatten]] void quantize_row(const float* values, Code* codes, std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) {
    truncate(clamp_unit(F::load(values + i)) * F(greatest) + F(0.5f)).store_as(codes + i);
  });
}

template <class Full, class One>
constexpr TransferKernels transfer_rows() {
  return {.encode = &encode_row<Full, One>,
          .decode = &decode_row<Full, One>,
          .quantize8 = &quantize_row<Full, One, std::uint8_t, 255>,
          .quantize16 = &quantize_row<Full, One, std::uint16_t, 65535>};
}

}  // namespace stages
}  // namespace zoneplate
