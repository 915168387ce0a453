// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/antialias/temporal/color_planes.h"
#include "zoneplate/base/isa.h"

namespace zoneplate::antialias {

/// A bilinear sample of a frame: the weights of the 3 × 3 pixels, by row, of which at most four are not 0.
struct GuidedSample {
  int pixel[4];     ///< of the 3 × 3, by row
  float weight[4];  ///< their sum is 1
};

/// The samples that a pixel may become, the one at its centre first.
struct GuidedSamples {
  static constexpr int count = 17;
  GuidedSample sample[count];
};

/// One row of a frame with the last result, for GuidedKernels::resolve.
///
/// Shape     as TemporalRow: planes of this frame continue for TemporalRow::border pixels, those of the history do not.
struct GuidedRow {
  ColorPlanes<const float> color;
  const float* nearness;   ///< reversed depth
  std::ptrdiff_t stride;   ///< of `nearness`
  const float* motion[2];  ///< in pixels, without a border
  const float* column;     ///< 0, 1, 2, ...
  int y, width, height;
  ColorPlanes<const float> history;
  bool is_first;  ///< there is no history
  ColorPlanes<float> resolved;
};

struct GuidedKernels : PerIsa<GuidedKernels> {
  /// The sample of each of n pixels that is nearest to the history; the centre's where there is no surface in 3 × 3
  /// pixels, or no history.
  ///
  /// Exact     where all colours are equal, the result is that colour, bit by bit.
  void (*resolve)(const GuidedRow& row, const GuidedSamples& samples, std::size_t n);
};

}  // namespace zoneplate::antialias
