// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// Operations on every byte of an image before compression.
struct PngRowKernels : PerIsa<PngRowKernels> {
  /// PNG's filter Up: row - above for n bytes, modulo 256.
  void (*up)(const std::uint8_t* row, const std::uint8_t* above, std::size_t n, std::uint8_t* out);
  /// The same filter for n pixels of four bytes; the fourth byte is omitted.
  void (*up_rgb)(const std::uint8_t* row, const std::uint8_t* above, std::size_t n, std::uint8_t* out);
  /// Adler-32 of the n bytes: (sum of all prefix sums) << 16 | sum, both modulo 65521 and starting at 1.
  ///
  /// Source    RFC 1950.
  std::uint32_t (*adler)(const std::uint8_t* p, std::size_t n);
};

}  // namespace zoneplate
