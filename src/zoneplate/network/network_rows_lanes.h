// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

#include "zoneplate/network/network_rows.h"

/// NetworkKernels over a lane type of math/lanes.h, whose lanes are output channels. `Products` is a sum of products of
/// integers for each lane: of pairs of weights, which lie side by side for each lane, with one pair of inputs.
namespace zoneplate::stages {

/// The sums of `pixels` neighbouring pixels for `vectors` groups of outputs, so that each weight is read once for all
/// pixels, and each input once for all outputs.
template <class F, class Sums, int vectors, int pixels>
[[gnu::always_inline]] inline void convolve_some(const ConvolutionRow& row, std::ptrdiff_t first,
                                                 std::ptrdiff_t output) {
  const std::ptrdiff_t step = std::ptrdiff_t{row.stride} * row.inputs, in_row = std::ptrdiff_t{row.side} * row.inputs;
  Sums sums[vectors][pixels];
  const std::int16_t* weight = row.weights + 2 * output;
  for (int y = 0; y < row.side; ++y) {
    const std::int16_t* const input = row.input[y] + first * step;
    for (std::ptrdiff_t k = 0; k < in_row; k += 2, weight += std::ptrdiff_t{2} * row.all_outputs) {
      typename Sums::Weights weights[vectors];
      for (int v = 0; v < vectors; ++v) weights[v] = Sums::load(weight + 2 * v * F::lanes);
      for (int p = 0; p < pixels; ++p) {
        std::int32_t pair;
        std::memcpy(&pair, input + p * step + k, sizeof pair);
        const typename Sums::Inputs inputs = Sums::both(pair);
        for (int v = 0; v < vectors; ++v) sums[v][p].add(weights[v], inputs);
      }
    }
  }
  for (int v = 0; v < vectors; ++v) {
    const std::ptrdiff_t o = output + v * F::lanes;
    const F scale = F::load(row.scale + o);
    const typename F::Int bias = F::Int::load(row.bias + o);
    for (int p = 0; p < pixels; ++p) {
      const F value = F::from(sums[v][p].total() + bias) * scale;
      const std::ptrdiff_t to = (first + p) * row.channels + o;
      if (row.sums)
        value.store(row.sums + to);
      else  // an activation is a whole number from 0 to 127
        truncate(min(max(floor(value + F(0.5f)), F(0.0f)), F(127.0f))).store_as(row.activations + to);
    }
  }
}

template <class Wide, class F, template <class> class Products, int pixels>
[[gnu::always_inline]] inline void convolve_pixels(const ConvolutionRow& row, std::ptrdiff_t first) {
  std::ptrdiff_t o = 0;
  // Two vectors of outputs share each input; one alone is enough where it has as many lanes.
  constexpr int vectors = Wide::lanes > F::lanes ? 1 : 2;
  constexpr std::ptrdiff_t step = std::ptrdiff_t{vectors} * Wide::lanes;
  for (; o + step <= row.outputs; o += step) convolve_some<Wide, Products<Wide>, vectors, pixels>(row, first, o);
  for (; o < row.outputs; o += F::lanes) convolve_some<F, Products<F>, 1, pixels>(row, first, o);
}

template <class Wide, class F, template <class> class Products>
[[gnu::flatten]] void convolve_row(const ConvolutionRow& row, std::size_t n) {
  constexpr int together = Wide::lanes > F::lanes ? 8 : 4;
  std::ptrdiff_t i = 0;
  const auto end = static_cast<std::ptrdiff_t>(n);
  for (; i + together <= end; i += together) convolve_pixels<Wide, F, Products, together>(row, i);
  for (; i < end; ++i) convolve_pixels<Wide, F, Products, 1>(row, i);
}

template <class Wide, class F, template <class> class Products>
constexpr NetworkKernels network_rows() {
  return {.convolve = &convolve_row<Wide, F, Products>};
}

}  // namespace zoneplate::stages
