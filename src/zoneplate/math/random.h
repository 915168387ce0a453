// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zoneplate {

/// A counter-based random word: equal keys give equal words, and there is no generator state.
///
/// Exact     integer arithmetic only; the same on every machine.
/// Source    the 32-bit finaliser of Chris Wellons' hash prospector ("lowbias32", constants found by search).
constexpr std::uint32_t hash(std::uint32_t a, std::uint32_t b = 0, std::uint32_t c = 0, std::uint32_t d = 0) {
  const auto mix = [](std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
  };
  return mix(a + mix(b + mix(c + mix(d + 0x9e3779b9u))));
}

/// Converts a word to a number in [0, 1), a multiple of 2^-24.
constexpr float unit_float(std::uint32_t word) { return static_cast<float>(word >> 8) * 0x1p-24f; }

}  // namespace zoneplate
