// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/raster/types/sampling.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {

/// A position packed so that sums of positions stay packed: x in bits 0 to 11, y in bits 12 to 23, a count from bit 24
/// on. At most 16 may be added.
constexpr std::int32_t summand(SamplePosition place) { return place.x | place.y << 12 | 1 << 24; }

/// The mean of n positions whose sum is (x, y), with halves rounded up.
constexpr SamplePosition mean_position(int x, int y, int n) {
  return {static_cast<std::uint8_t>((2 * x + n) / (2 * n)), static_cast<std::uint8_t>((2 * y + n) / (2 * n))};
}

/// The mean of positions from the sum of their summands.
constexpr SamplePosition mean_position(std::int32_t sum) {
  return mean_position(sum & 4095, sum >> 12 & 4095, sum >> 24);
}

/// Where surfaces are shaded, for one rule and one sample pattern: at `whole` if they own all of a pixel's samples,
/// else at the mean of the summands `first` of the first sample and `more` of the other samples. `more` is 0 where the
/// rule ignores them.
///
/// Exact     the mean of samples that a triangle covers lies on the triangle, up to the rounding to 1/256 pixel. Where
///           triangles share a pixel of a pattern whose mean is the centre, so is the mean of their positions, weighted
///           by their samples: a colour that is linear over the triangles resolves as if one triangle covered the whole
///           pixel.
/// Source    centroid sampling: any position inside both the pixel and the primitive (OpenGL Shading Language,
/// `centroid`);
///           hardware takes the mean of the covered samples (Zink, Pettineo, Hoxley, Practical Rendering and
///           Computation with Direct3D 11, 2011), or the first of them.
struct CentroidTable {
  std::vector<std::int32_t> first, more;
  SamplePosition whole;
  CentroidTable(const SamplePattern& samples, Centroid rule);
  /// The position for a set of samples that is not all of them; bit 0 is sample `begin`.
  SamplePosition of(std::uint64_t samples, int begin) const;
};

}  // namespace zoneplate
