// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/math/random.h"

namespace zoneplate {

/// The first word of a key (a, b, c, d) whose `hash` is `expected`, found by inverting the hash, as the author of a
/// malicious file could.
constexpr std::uint32_t colliding_word(std::uint32_t expected, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const auto mix = [](std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
  };
  const auto inverse = [](std::uint32_t odd) {  // the inverse modulo 2^32, by Newton's iteration
    std::uint32_t x = odd;
    for (int i = 0; i < 5; ++i) x *= 2 - odd * x;
    return x;
  };
  const auto unmix = [&](std::uint32_t x) {
    x = (x ^ (x >> 16)) * inverse(0x846ca68bu);
    x = (x ^ (x >> 15) ^ (x >> 30)) * inverse(0x7feb352du);
    return x ^ (x >> 16);
  };
  return unmix(expected) - mix(b + mix(c + mix(d + 0x9e3779b9u)));
}
static_assert(hash(colliding_word(12345, 1, 2, 3), 1, 2, 3) == 12345);

}  // namespace zoneplate
