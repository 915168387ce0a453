// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// One row of a convolution.
struct ConvolutionRow {
  const float* input[3];  ///< the rows around, from the first pixel that the first output reads; all numbers are whole
  int inputs, outputs;    ///< channels; the latter a multiple of 8
  int side, stride;
  const float *weights, *scale, *bias;
  bool is_last;         ///< the sums times the scale are the result, instead of activations
  float* output;        ///< of the first pixel
  int output_channels;  ///< numbers from one output pixel to the next
};

/// Exact     the same bits on every instruction set.
struct NetworkKernels : PerIsa<NetworkKernels> {
  /// n pixels.
  void (*convolve)(const ConvolutionRow& row, std::size_t n);
};

}  // namespace zoneplate
