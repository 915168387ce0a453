// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"
#include "zoneplate/upscale/fsr1/easu.h"

namespace zoneplate {

struct RcasOptions {
  float sharpness = 1;          ///< factor of the lobe: 2 to the power of -stops
  bool limits_by_ring = false;  ///< only the four neighbours limit the lobe, not the pixel itself, as in FSR 2
  bool is_unbounded = false;    ///< the result is not clamped to [0, 1], for inputs beyond
  bool denoises = false;        ///< weaker where the pixel differs from all of its neighbours
  Reciprocals reciprocals = Reciprocals::Approximate;
};

/// Robust contrast-adaptive sharpening: subtracts a share of the four neighbours, the greatest one for which no channel
/// leaves [0, 1].
///
/// Exact     the same bits on every instruction set; the result is in [0, 1] unless it is unbounded, and a
///           constant stays within rounding, or with approximate reciprocals within 0.3 %.
/// Source    AMD, FidelityFX Super Resolution 1.0, ffx_fsr1.h: FsrRcasF.
struct RcasKernels : PerIsa<RcasKernels> {
  /// n pixels of four floats; alpha is sharpened by the colours' lobe, within its neighbours. `here` is valid from one
  /// pixel before the first to one after the last.
  void (*sharpen_row)(const float* above, const float* here, const float* below, const RcasOptions& options, float* out,
                      std::size_t n);
};

}  // namespace zoneplate
