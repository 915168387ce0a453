// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// What all rows of an output of FSR 2 have in common.
struct Fsr2AccumulateFrame {
  std::int32_t width, height;  ///< of the output
  bool is_first;               ///< there is no history
  bool rectifies;
  bool has_lanczos;               ///< otherwise history is bilinear, and the frame's kernel has no negative lobes
  float exposure, exposure_root;  ///< the exposure to the power of 1/6
  float kernel_max;               ///< the narrowest kernel: output pixels per frame pixel, at most 1.99
  float box_scale;                ///< standard deviations to which the history of still pixels is clamped
  float lock_decrease;            ///< of a lock's life, per weight of the frame's samples

  // Of the last frame, in the output's size.
  const float *history, *lumas;  ///< four floats per pixel
  const float *lock_life, *lock_luma;
};

/// The input of one output row of FSR 2: the three rows and columns of the frame around each output pixel. The frame's
/// planes have a border of one pixel, which is 0; columns are indices in floats.
struct Fsr2AccumulateRow {
  const float* prepared[3];  ///< Y, Co, Cg and the depth clip of the frame's pixels
  const std::int32_t* columns[3];
  const float* dx[3];  ///< offset of the samples from the output pixel's centre, in frame pixels
  float dy[3];
  const float* is_column[3];  ///< 1 in the frame, 0 in its border
  float is_row[3];

  const float *clips[2], *masks[2];  ///< rows of the prepared pixels and of the accumulation mask
  const std::int32_t *clip_column, *mask_column;
  const float* clip_right;  ///< distance of the output pixel from the column, in [0, 1]
  float clip_below;

  const float* motion;  ///< two floats per pixel: to the last frame, in widths and heights of the image
  const std::int32_t* motion_column;

  const float* luminances[2];  ///< rows of the blocks' mean logarithms
  const std::int32_t* luminance_columns[2];
  const float* luminance_right;
  float luminance_below;

  const float* u;  ///< the output pixels' centres in [0, 1]
  float v;
  const float* new_locks;

  float *history, *lumas;  ///< the output
  float *lock_life, *lock_luma;
};

/// The pass of FSR 2 that makes output pixels.
///
/// Exact     the same bits on every instruction set.
/// Source    AMD, FidelityFX-FSR2 2.2.1: ffx_fsr2_accumulate.h, _upsample.h, _reproject.h, _postprocess_lock_status.h.
struct Fsr2AccumulateKernels : PerIsa<Fsr2AccumulateKernels> {
  /// One row of n pixels.
  void (*accumulate_row)(const Fsr2AccumulateFrame& frame, const Fsr2AccumulateRow& row, std::size_t n);
};

}  // namespace zoneplate
