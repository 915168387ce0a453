// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/jitter.h"

#include <cstdint>

namespace zoneplate::antialias {
namespace {

/// 2^32 / p and 2^32 / p², rounded, for the plastic number p = 1.3247...: the real root of p³ = p + 1. Sums wrap around
/// as the fractional parts do.
constexpr std::uint32_t step_x = 3242174889u, step_y = 2447445414u, half = 0x80000000u;

}  // namespace

SamplePattern jitter_pattern(JitterSequence sequence, int length) {
  if (sequence == JitterSequence::Halton) return named_pattern("halton", length);
  if (sequence == JitterSequence::None) return {SamplePosition{}};
  SamplePattern out;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(length); ++i)
    out.push_back(
        {static_cast<std::uint8_t>((half + i * step_x) >> 24), static_cast<std::uint8_t>((half + i * step_y) >> 24)});
  return out;
}

}  // namespace zoneplate::antialias
