// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// What all pixels of an output image have in common.
struct TaauFrame {
  std::int32_t width, height;  ///< of the output
  bool is_first;               ///< there is no history
  float scale[2];              ///< output pixels per frame pixel, per axis
  float radius;                ///< samples at less than this, in frame pixels, limit the history
  const float* history;        ///< of the last frame, in the output's size: four floats per pixel
};

/// The input of one output row: the three rows and columns of the frame around each output pixel.
struct TaauRow {
  const float* color[3];                   ///< four floats per pixel, finite and not negative
  const std::int32_t* columns[3];          ///< pixels of the frame
  const float* nearness[3];                ///< reversed depth
  const float *motion_x[3], *motion_y[3];  ///< in frame pixels
  const float* dx;                         ///< from the middle sample to the output pixel's centre, in frame pixels
  float dy;
  const float* column;  ///< 0, 1, 2, ...
  std::int32_t y;

  float* resolved;  ///< out: four floats per pixel
};

/// The resolve of temporal antialiasing that upsamples.
///
/// Exact     the same bits on every instruction set. Where all colours and the history are equal, the result is that
///           colour, bit by bit.
struct TaauKernels : PerIsa<TaauKernels> {
  /// One row of n pixels.
  void (*resolve_row)(const TaauFrame& frame, const TaauRow& row, std::size_t n);
};

}  // namespace zoneplate
