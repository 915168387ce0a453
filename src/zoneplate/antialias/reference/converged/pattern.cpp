// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/converged/pattern.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "zoneplate/math/random.h"

namespace zoneplate::antialias {
namespace {

std::uint32_t reversed(std::uint32_t v) {
  std::uint32_t out = 0;
  for (int bit = 0; bit < 32; ++bit) out |= (v >> bit & 1) << (31 - bit);
  return out;
}

/// The second coordinate of point i: its direction numbers are Pascal's triangle modulo two.
std::uint32_t second(std::uint32_t i) {
  std::uint32_t out = 0, direction = 0x80000000u;
  for (; i > 0; i >>= 1) {
    if (i & 1) out ^= direction;
    direction ^= direction >> 1;
  }
  return out;
}

std::uint32_t scrambled(std::uint32_t v, std::uint32_t dimension, std::uint32_t seed) {
  std::uint32_t flips = 0;
  for (std::uint32_t depth = 0; depth < 32; ++depth) {
    const std::uint32_t above = depth == 0 ? 0 : v >> (32 - depth);
    flips |= (hash(above, depth, dimension, seed) & 1) << (31 - depth);
  }
  return v ^ flips;
}

std::uint8_t nearest_place(std::uint32_t v) {
  return static_cast<std::uint8_t>(std::clamp<std::uint32_t>(((v >> 23) + 1) >> 1, 1, 255));
}

}  // namespace

ScrambledPoint scrambled_point(std::uint32_t i, std::uint32_t seed) {
  return {scrambled(reversed(i), 0, seed), scrambled(second(i), 1, seed)};
}

SamplePattern scrambled_pattern(int samples, std::uint32_t seed) {
  assert(samples > 0 && std::has_single_bit(static_cast<unsigned>(samples)));
  SamplePattern out;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(samples); ++i) {
    const ScrambledPoint p = scrambled_point(i, seed);
    out.push_back({nearest_place(p.x), nearest_place(p.y)});
  }
  return out;
}

}  // namespace zoneplate::antialias
