// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/learned/network_rows.h"

/// NetworkKernels over a lane type of math/lanes.h, whose lanes are output channels.
namespace zoneplate::stages {

/// `pixels` neighbouring pixels at once, so that each weight is read once for all of them.
template <class F, int pixels>
[[gnu::always_inline]] inline void convolve_some(const ConvolutionRow& row, std::ptrdiff_t first) {
  for (std::ptrdiff_t o = 0; o < row.outputs; o += F::lanes) {
    F sum[pixels];
    for (F& s : sum) s = F::load(row.bias + o);
    const float* weight = row.weights + o;
    for (int y = 0; y < row.side; ++y) {
      const float* const input = row.input[y] + first * row.stride * row.inputs;
      for (std::ptrdiff_t k = 0; k < std::ptrdiff_t{row.side} * row.inputs; ++k, weight += row.outputs) {
        const F w = F::load(weight);
        for (int p = 0; p < pixels; ++p)
          sum[p] = sum[p] + w * F(input[std::ptrdiff_t{p} * row.stride * row.inputs + k]);
      }
    }
    const F scale = F::load(row.scale + o);
    for (int p = 0; p < pixels; ++p) {
      const F value = sum[p] * scale;
      float* const to = row.output + (first + p) * row.output_channels + o;
      // An activation is a whole number from 0 to 127.
      (row.is_last ? value : min(max(floor(value + F(0.5f)), F(0.0f)), F(127.0f))).store(to);
    }
  }
}

template <class F>
[[gnu::flatten]] void convolve_row(const ConvolutionRow& row, std::size_t n) {
  std::ptrdiff_t i = 0;
  const auto end = static_cast<std::ptrdiff_t>(n);
  for (; i + 8 <= end; i += 8) convolve_some<F, 8>(row, i);
  for (; i < end; ++i) convolve_some<F, 1>(row, i);
}

template <class F>
constexpr NetworkKernels network_rows() {
  return {.convolve = &convolve_row<F>};
}

}  // namespace zoneplate::stages
