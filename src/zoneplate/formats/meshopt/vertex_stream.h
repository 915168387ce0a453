// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace zoneplate {

/// Whether packed attributes are of version 1, which the library does not decode.
inline bool is_vertex_stream1(std::span<const std::uint8_t> packed) { return !packed.empty() && packed[0] == 0xa1; }

/// Decodes attributes of version 1 into `out`, which has a whole number of elements of `stride` bytes. Returns false
/// for an invalid stream.
///
/// Requires  stride is a multiple of 4 in [4, 256].
/// Source    KHR_meshopt_compression, appendix A, "Mode 0: attributes".
bool decode_vertex_stream1(std::span<const std::uint8_t> packed, std::size_t stride, std::span<std::uint8_t> out);

/// Converts colours from YCoCg with a precision of their own to RGBA, in place; components have `stride` / 4 bytes.
///
/// Requires  stride is 4 or 8.
/// Source    KHR_meshopt_compression, appendix B, "Filter 4: color".
void filter_colors(std::span<std::uint8_t> elements, std::size_t stride);

}  // namespace zoneplate
