// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// What the console path reads around the pixels of a row.
struct FxaaConsoleRows {
  static constexpr int reach = 5;
  const std::uint8_t* luma;                  ///< valid `reach` values around
  std::ptrdiff_t stride;                     ///< of luma
  const std::uint8_t* codes[2 * reach + 1];  ///< rows of codes, the pixels' own in the middle;
                                             ///< their outermost go on
};

struct FxaaConsoleKernels : PerIsa<FxaaConsoleKernels> {
  static constexpr float nudge = 255.0f / 384;  ///< of one of four lumas, which keeps the direction from being zero

  /// 1 where the lumas around a pixel differ by `least` and by the share
  /// `threshold` of the greatest at least; else 0.
  ///
  /// Shape     reads and writes whole vectors, so that the arrays have room for
  /// n rounded up to 64.
  void (*seen_row)(const FxaaConsoleRows& rows, float threshold, float least, std::uint8_t* seen, std::size_t n);
  /// Mixes the pixels that are seen; others of `out` are left alone.
  void (*mix_row)(const FxaaConsoleRows& rows, float sharpness, const std::uint8_t* seen, std::uint8_t* out,
                  std::size_t n);
};

}  // namespace zoneplate
