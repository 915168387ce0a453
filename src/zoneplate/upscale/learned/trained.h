// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace zoneplate::upscale {

/// The bytes of weights.bin, which the program contains.
std::span<const std::uint8_t> trained_weights();

}  // namespace zoneplate::upscale
