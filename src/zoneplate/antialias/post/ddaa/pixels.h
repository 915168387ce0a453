// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The constants of the method, as published.
struct DdaaConstants {
  static constexpr int search = 15;  ///< pixels to either side
  static constexpr float diffusion_step = 0.51f;
  static constexpr float scharr_middle = 162.0f / 256, scharr_corner = 47.0f / 256;
};

/// Power is the sum of weighed codes in [0, 1], of which luma is the root: what a fetch between two pixels averages.
///
/// Shape     rows of power are `stride` apart and valid `search` + 1 values around; reads and writes go in whole
///           vectors, up to 31 values after the n-th, and arrays have room for n rounded up to 64.
struct DdaaKernels : PerIsa<DdaaKernels> {
  /// (299 R + 587 G + 114 B) / 255000 of n pixels of four codes.
  void (*power_row)(const std::uint8_t* rgba, float* power, std::size_t n);
  /// 1 where lumas of a pixel and its four neighbours differ, and by `least` and the share `threshold` of the greatest
  /// at least; else 0.
  void (*seen_row)(const float* power, std::ptrdiff_t stride, float threshold, float least, std::uint8_t* seen,
                   std::size_t n);
  /// Where a seen pixel's colour comes from: the mean of two points around its own; four floats a pixel, x and y of
  /// either. Nothing valid is written for others.
  void (*taps_row)(const float* power, std::ptrdiff_t stride, float strength, const std::uint8_t* seen, float* taps,
                   std::size_t n);
  /// Fetches seen pixels; `rows` are five rows of codes, the pixels' own in the middle, whose outermost pixels go on.
  void (*fetch_row)(const std::uint8_t* const* rows, const float* taps, const std::uint8_t* seen, std::uint8_t* out,
                    std::size_t n);
};

}  // namespace zoneplate
