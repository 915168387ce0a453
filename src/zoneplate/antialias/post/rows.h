#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// What the post-process filters do to whole rows. The library's copy of a row takes three times as long on some
/// processors where the two lie unluckily (Zen 3: a little above each other, whole pages left out).
struct RowKernels : PerIsa<RowKernels> {
  void (*copy)(const std::uint8_t* from, std::uint8_t* to, std::size_t n);
  /// Copies past the caches: what was there is not read first, and what is in the caches stays there.
  void (*stream)(const std::uint8_t* from, std::uint8_t* to, std::size_t n);
  /// 2126 R + 7152 G + 722 B, exactly, of n pixels of four sRGB-encoded bytes.
  void (*luma)(const std::uint8_t* rgba, float* luma, std::size_t n);
};

}  // namespace zoneplate
