// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The input of the console path for the pixels of a row.
struct FxaaConsoleRows {
  static constexpr int radius = 5;
  const std::uint8_t* luma;  ///< valid for `radius` values around
  std::ptrdiff_t stride;     ///< stride of luma
  /// Rows of codes, the pixels' own in the middle; beyond their ends the outermost pixels are repeated.
  const std::uint8_t* codes[2 * radius + 1];
};

struct FxaaConsoleKernels : PerIsa<FxaaConsoleKernels> {
  static constexpr float nudge = 255.0f / 384;  ///< offset of one of four lumas, so that the direction is never zero

  /// 1 if the range of lumas around a pixel is at least the greater of `least` and `threshold` times the greatest luma;
  /// else 0.
  ///
  /// Shape     whole vectors are read and written, so that the arrays have capacity for n rounded up to 64.
  void (*seen_row)(const FxaaConsoleRows& rows, float threshold, float least, std::uint8_t* seen, std::size_t n);
  /// Filters the pixels selected in `seen`; the other pixels of `out` are unchanged.
  void (*mix_row)(const FxaaConsoleRows& rows, float sharpness, const std::uint8_t* seen, std::uint8_t* out,
                  std::size_t n);
};

}  // namespace zoneplate
