// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The scales of SRAA's weights: exp(-scale max(1 - N·N', depth |z - z'| / min(z, z'))).
struct BilateralScales {
  float scale, depth;
};

struct SraaKernels : PerIsa<SraaKernels> {
  /// Adds the contributions of n shaded pixels to n samples: their weighted colours to `sum`, and the weights to
  /// `weight`.
  ///
  /// Shape     four floats per pixel, one of `weight`: geometry as in Frame::sample_geometry, colours r, g, b, a.
  /// Edges     the weight is 1 if pixel and sample are both empty, and 0 if only one of them is.
  void (*add)(const float* sample, const float* centre, const float* color, const BilateralScales& scales, float* sum,
              float* weight, std::size_t n);
};

}  // namespace zoneplate
