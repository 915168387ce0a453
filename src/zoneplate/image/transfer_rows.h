// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The transfer functions on arrays of channel values.
struct TransferKernels : PerIsa<TransferKernels> {
  /// encode_srgb and decode_srgb of each value.
  void (*encode)(const float* linear, float* code, std::size_t n);
  void (*decode)(const float* code, float* linear, std::size_t n);
  /// floor(255 x + 0.5) and floor(65535 x + 0.5) with x clamped to [0, 1]; NaN counts as 0.
  void (*quantize8)(const float* values, std::uint8_t* codes, std::size_t n);
  void (*quantize16)(const float* values, std::uint16_t* codes, std::size_t n);
};

}  // namespace zoneplate
