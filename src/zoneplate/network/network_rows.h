// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// One row of a convolution.
struct ConvolutionRow {
  const std::int16_t* input[3];  ///< the rows around, from the first pixel that the first output reads
  int inputs, outputs;           ///< channels: a multiple of 2, and one of 8
  int side, stride;
  const std::int16_t* weights;  ///< by row, pair of a row's inputs, output and input
  const float* scale;
  const std::int32_t* bias;
  int all_outputs;                      ///< of the layer, by which its weights are arranged
  std::int16_t* activations = nullptr;  ///< out: of the first pixel, if `sums` is null
  float* sums = nullptr;                ///< out: the last layer's, times the scale
  int channels;                         ///< numbers from one pixel's output to the next
};

/// Exact     the same bits on every instruction set.
struct NetworkKernels : PerIsa<NetworkKernels> {
  /// n pixels.
  void (*convolve)(const ConvolutionRow& row, std::size_t n);
};

}  // namespace zoneplate
