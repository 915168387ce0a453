// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/upscale/fsr3/prepare.h"

namespace zoneplate {

/// What all rows of an output of FSR 3 have in common.
struct Fsr3AccumulateFrame {
  std::int32_t width, height;  ///< of the output
  bool is_first;               ///< there is no history
  bool rectifies;
  float exposure;
  float kernel_max;          ///< the narrowest kernel: output pixels per frame pixel, at most 1.99
  float lock_decrease;       ///< of a lock, per frame
  float velocity_factor;     ///< of the velocity by which history counts less
  std::int32_t tone_mapped;  ///< from a prepared pixel to the tone-mapped one, in floats
  const float* history;      ///< of the last frame, in the output's size: red, green, blue, lock
};

/// The input of one output row of FSR 3: the three rows and columns of the frame around each output pixel. The prepared
/// pixels have a border of one pixel, which repeats those at the edges.
struct Fsr3AccumulateRow {
  const float* prepared[3];        ///< four floats per pixel: Y, Co, Cg of the exposed colours
  const std::int32_t* columns[3];  ///< indices in floats
  const float* dx[3];              ///< offset of the samples from the output pixel's centre, in frame pixels
  float dy[3];
  const float* is_column[3];  ///< 1 in the frame, 0 in its border
  float is_row[3];
  const float* box_x[3];  ///< factors of the samples' weights in the box of colours
  float box_y[3];

  Fsr3Between masks;  ///< the four of Fsr3PrepareKernels::reactivity_row
  Fsr3Between instability, farthest_depth;

  const float* motion;  ///< two floats per pixel: to the last frame, in widths and heights of the image
  const std::int32_t* motion_column;
  const float* u;  ///< the output pixels' centres in [0, 1]
  float v;
  const float* new_locks;

  float* history;  ///< the output
};

/// The pass of FSR 3 that makes output pixels.
///
/// Exact     the same bits on every instruction set.
/// Source    AMD, FidelityFX SDK 1.1.4: ffx_fsr3upscaler_accumulate.h, _upsample.h and _reproject.h.
struct Fsr3AccumulateKernels : PerIsa<Fsr3AccumulateKernels> {
  /// One row of n pixels.
  void (*accumulate_row)(const Fsr3AccumulateFrame& frame, const Fsr3AccumulateRow& row, std::size_t n);
};

}  // namespace zoneplate
