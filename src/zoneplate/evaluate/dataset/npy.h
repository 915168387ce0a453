// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace zoneplate {

/// Encodes an array of NumPy, version 1.0 of the format, in C order: `<f4`, `<u4` or `|u1`.
///
/// Requires  the shape has at least one length, and their product is the number of values.
/// Source    numpy.lib.format.
std::vector<std::uint8_t> encode_npy(std::span<const int> shape, std::span<const float> values);
std::vector<std::uint8_t> encode_npy(std::span<const int> shape, std::span<const std::uint32_t> values);
std::vector<std::uint8_t> encode_npy(std::span<const int> shape, std::span<const std::uint8_t> values);

}  // namespace zoneplate
