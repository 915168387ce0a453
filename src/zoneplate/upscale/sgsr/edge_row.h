// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The input of one output row of SGSR 1. Pixels have four floats.
struct SgsrRow {
  const float* rows[4];            ///< pixels of the rows y - 1 to y + 2, where y is the row above the output's centre
  const std::int32_t* columns[4];  ///< in floats, of the columns x - 1 to x + 2, clamped to the input
  const float* right;              ///< distance of the output's centre from column x, in [0, 1)
  float below;                     ///< the same from row y
};

/// The operation of Snapdragon Game Super Resolution 1.
///
/// Exact     the same bits on every instruction set.
/// Source    Qualcomm, snapdragon-gsr, sgsr/v1: sgsr1_shader_mobile.frag, mode RGBA with UseEdgeDirection.
struct SgsrKernels : PerIsa<SgsrKernels> {
  /// One row of n output pixels.
  void (*upscale_row)(const SgsrRow& row, float* out, std::size_t n);
};

}  // namespace zoneplate
