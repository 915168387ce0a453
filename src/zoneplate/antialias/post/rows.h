// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// Operations of the post-process filters on whole rows. `copy` exists because the C library's memcpy takes three times
/// as long on some processors for unfavourable addresses (Zen 3: a destination slightly above the source, modulo the
/// page size).
struct RowKernels : PerIsa<RowKernels> {
  void (*copy)(const std::uint8_t* from, std::uint8_t* to, std::size_t n);
  /// Copies with streaming stores: the destination is not read first, and the contents of the caches are kept.
  void (*stream)(const std::uint8_t* from, std::uint8_t* to, std::size_t n);
  /// 2126 R + 7152 G + 722 B, exactly, of n pixels of four sRGB-encoded bytes.
  void (*luma)(const std::uint8_t* rgba, float* luma, std::size_t n);
};

}  // namespace zoneplate
