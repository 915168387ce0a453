// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace zoneplate {

/// A sample's position in its pixel, in 1/256 pixel from the pixel's top-left corner.
struct SamplePosition {
  std::uint8_t x = 128, y = 128;  ///< to the right and downwards; the pixel's centre by default
  bool operator==(const SamplePosition&) const = default;
};

/// The sample positions of every pixel of a frame; a sample's number is its index here.
using SamplePattern = std::vector<SamplePosition>;

/// The standard multisample pattern of n = 1, 2, 4, 8 or 16 samples.
///
/// Source    Direct3D 11.1 standard sample patterns, the same as Vulkan's (standardSampleLocations), in their order.
SamplePattern standard_pattern(int n);

/// The regular grid of n × n samples at ((i + ½) / n, (j + ½) / n), rows from the top, n in [1, 16].
SamplePattern grid_pattern(int n);

/// A named pattern of `samples` positions in [0, 1)²: "grid" (a square number), "rotated" (the square grid turned by
/// atan(1/n)), "halton" (bases 2 and 3), "r2" (Roberts), "sobol" (in the middle of its cells, of which 2^k samples have
/// one each on every lattice of 2^k), "nrooks".
///
/// The mean of the positions is the pixel's centre within 1/512 pixel, so that no pattern moves the image: sequences,
/// of which any number of elements may be taken, are moved by what their mean lacks.
///
/// Errors    ErrorKind::Usage for an unknown name or a number of samples that the pattern does not have.
SamplePattern named_pattern(const std::string& name, int samples);

/// Elements 1 to `samples` of Halton's sequence of bases 2 and 3, rounded down to 1/256 pixel, as engines publish their
/// jitter. The mean of 16 is 0.029 pixel left of the centre and 0.039 pixel above it.
SamplePattern halton_sequence(int samples);

}  // namespace zoneplate
#pragma GCC visibility pop
