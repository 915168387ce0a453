// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/signal/samples.h"

namespace zoneplate::antialias {

/// Stratified random positions in a pixel: the first points of the Sobol sequence, scrambled.
///
/// Every run of 2^k points that starts at a multiple of 2^k is stratified: each of 2^k equal boxes, vertical or
/// horizontal, contains one. Positions are rounded to the nearest 1/256 pixel and clamped to [1, 255] / 256, so that
/// their mean remains the pixel's centre.
///
/// Requires  `samples` is a power of two.
/// Source    Owen, Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences, 1995: each digit is flipped by a hash of those
///           above it.
SamplePattern scrambled_pattern(int samples, std::uint32_t seed = 0);

/// Point i of the same sequence before rounding, as fractions of the pixel in units of 2^-32.
struct ScrambledPoint {
  std::uint32_t x, y;
};
ScrambledPoint scrambled_point(std::uint32_t i, std::uint32_t seed = 0);

}  // namespace zoneplate::antialias
