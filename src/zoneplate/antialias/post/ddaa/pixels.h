// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The constants of the method, as published.
struct DdaaConstants {
  static constexpr int search = 15;  ///< pixels on either side
  static constexpr float diffusion_step = 0.51f;
  static constexpr float scharr_middle = 162.0f / 256, scharr_corner = 47.0f / 256;
};

/// Power is the weighted sum of codes in [0, 1] of which luma is the square root; a fetch between two pixels averages
/// power.
///
/// Shape     rows of power are `stride` apart and valid for `search` + 1 values around; whole vectors are read and
///           written, up to 31 values after the n-th, and arrays have capacity for n rounded up to 64.
struct DdaaKernels : PerIsa<DdaaKernels> {
  /// (299 R + 587 G + 114 B) / 255000 of n pixels of four bytes.
  void (*power_row)(const std::uint8_t* rgba, float* power, std::size_t n);
  /// 1 if the range of lumas of a pixel and its four neighbours is not 0 and at least the greater of `least` and
  /// `threshold` times the greatest luma; else 0.
  void (*seen_row)(const float* power, std::ptrdiff_t stride, float threshold, float least, std::uint8_t* seen,
                   std::size_t n);
  /// The two points whose mean is the colour of a pixel selected in `seen`, relative to its centre: four floats per
  /// pixel, x and y of each point. The values of other pixels are unspecified.
  void (*taps_row)(const float* power, std::ptrdiff_t stride, float strength, const std::uint8_t* seen, float* taps,
                   std::size_t n);
  /// Fetches the selected pixels. `rows` are five rows of codes with the pixels' own in the middle; beyond their ends
  /// the outermost pixels are repeated.
  void (*fetch_row)(const std::uint8_t* const* rows, const float* taps, const std::uint8_t* seen, std::uint8_t* out,
                    std::size_t n);
};

}  // namespace zoneplate
