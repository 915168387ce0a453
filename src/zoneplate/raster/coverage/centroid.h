#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/raster/types/sampling.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {

/// A place to be added to others: x in bits 0 to 11, y in bits 12 to 23, a one from bit 24 on. At most 16 add up.
constexpr std::int32_t summand(SamplePosition place) { return place.x | place.y << 12 | 1 << 24; }

/// The mean of n places whose sum is (x, y), halves rounded up.
constexpr SamplePosition mean_place(int x, int y, int n) {
  return {static_cast<std::uint8_t>((2 * x + n) / (2 * n)), static_cast<std::uint8_t>((2 * y + n) / (2 * n))};
}

/// That of a sum of summands.
constexpr SamplePosition mean_place(std::int32_t sum) { return mean_place(sum & 4095, sum >> 12 & 4095, sum >> 24); }

/// A rule and a pattern as summands by sample: a surface is shaded at the mean of `first` of its first sample and
/// `more` of its others, which are 0 where the rule has no use for them.
///
/// Exact     a mean of samples that a triangle covers lies on it but for the rounding to 1/256 pixel; where triangles
///           share a pixel of a pattern whose mean is the centre, so is the mean of their places, weighted by their
///           samples: a colour that changes linearly over them comes out as if one triangle had the whole pixel.
/// Source    centroid sampling: any place inside both the pixel and the primitive (OpenGL Shading Language,
/// `centroid`);
///           hardware takes the mean of the covered samples (Zink, Pettineo, Hoxley, Practical Rendering and
///           Computation with Direct3D 11, 2011), or the first of them.
struct ShadedPlaces {
  std::vector<std::int32_t> first, more;
  ShadedPlaces(const SamplePattern& samples, Centroid rule);
  /// The place of samples, a bit each; bit 0 is sample `begin`.
  SamplePosition of(std::uint64_t samples, int begin) const;
};

}  // namespace zoneplate
