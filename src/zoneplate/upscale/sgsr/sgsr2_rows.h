// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// What all pixels of a frame have in common in the first pass of SGSR 2.
struct Sgsr2ConvertFrame {
  float separation;                 ///< depths that lie further apart than this, times 1 - depth, are two surfaces
  float last_clip_from_clip[4][4];  ///< by column
};

/// The input and output of one frame row of the first pass. Four floats per pixel are written to each output.
struct Sgsr2ConvertRow {
  const float* color;                ///< four floats per pixel
  const float* depth[4];             ///< at the first pixel of the row above, this one and the two below; there are
                                     ///< a pixel before and two after each row
  const float *motion_x, *motion_y;  ///< of objects, in halves of the image; NaN at points that rest in the world
  const float* x;                    ///< the pixels' centres in [-1, 1]
  float y;
  float* motion_clip;  ///< out: motion, depth clip, and the greatest channel plus 1
  float* ycocg;        ///< out: the compressed colour in steps of 11, 11 and 10 bits
};

/// What all output pixels have in common in the second pass.
struct Sgsr2UpscaleFrame {
  std::int32_t width, height;  ///< of the output
  bool is_first;               ///< there is no history
  int taps;                    ///< 5: a cross; 9: a square
  float kernel_max, box_scale;
  float rest_share;      ///< how much of unclamped history stays at rest
  const float* history;  ///< of the last frame, in the output's size: four floats per pixel
};

/// The input and output of one output row of the second pass.
struct Sgsr2UpscaleRow {
  const float* ycocg[3];           ///< the rows of the frame above, at and below the output pixel
  const std::int32_t* columns[3];  ///< likewise, as indices of floats
  const float* dx;                 ///< offset of the middle sample from the output pixel's centre, in frame pixels
  float dy;

  const float* motion_clip[2];  ///< the rows between which the output pixel's sample lies
  const std::int32_t* motion_columns[2];
  const float* motion_right;
  float motion_below;

  const float* u;  ///< the output pixels' centres in [0, 1]
  float v;

  float* history;  ///< out: Y, Co, Cg, compressed
  float* color;    ///< out: scene-linear, opaque
};

/// The passes of SGSR 2.
///
/// Exact     the same bits on every instruction set.
/// Source    Qualcomm, snapdragon-gsr, sgsr/v2, glsl_2_pass_cs: sgsr2_convert.comp, sgsr2_upscale.comp.
struct Sgsr2Kernels : PerIsa<Sgsr2Kernels> {
  /// One row of n pixels of the frame.
  void (*convert_row)(const Sgsr2ConvertFrame& frame, const Sgsr2ConvertRow& row, std::size_t n);
  /// One row of n pixels of the output.
  void (*upscale_row)(const Sgsr2UpscaleFrame& frame, const Sgsr2UpscaleRow& row, std::size_t n);
};

}  // namespace zoneplate
