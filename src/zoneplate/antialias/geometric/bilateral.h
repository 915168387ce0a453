#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The scales of SRAA's weights: exp(-scale max(1 - N·N', depth |z - z'| / min(z, z'))).
struct BilateralScales {
  float scale, depth;
};

struct SraaKernels : PerIsa<SraaKernels> {
  /// Adds what n shaded pixels say of n samples: their colours times their weights, and the weights alone.
  ///
  /// Shape     four floats a pixel, but one of `weight`: geometry as in Frame::sample_geometry, colours r, g, b, a.
  /// Edges     where nothing is at both places the weight is 1, where at one of them 0.
  void (*add)(const float* sample, const float* centre, const float* color, const BilateralScales& scales, float* sum,
              float* weight, std::size_t n);
};

}  // namespace zoneplate
