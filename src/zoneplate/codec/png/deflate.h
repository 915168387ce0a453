// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace zoneplate {

/// Appends one part of a DEFLATE stream: a block of `bytes` with a Huffman code of its own.
///
/// The only repetitions that are searched are runs of one byte, of which the filtered rows of a rendered image mostly
/// consist; that is some ten times as fast as a general search. The part ends at a byte boundary, so that parts from
/// several threads can be concatenated; the part with `is_last` ends the stream.
///
/// Requires  at most 2^24 bytes.
/// Source    Deutsch, DEFLATE Compressed Data Format Specification, RFC 1951, 1996.
void deflate_part(std::span<const std::uint8_t> bytes, bool is_last, std::vector<std::uint8_t>& out);

/// The lengths in bits of a Huffman code for symbols of these counts, none longer than `limit`; 0 where the count is 0.
///
/// A single symbol has length 1.
///
/// Exact     the same lengths for the same counts; the code is complete, and the best one where no length would be
///           beyond the limit (counts are halved until none is).
/// Requires  2^limit >= the number of symbols with a count; counts.size() == lengths.size() <= 512.
void huffman_lengths(std::span<const std::uint32_t> counts, int limit, std::span<std::uint8_t> lengths);

}  // namespace zoneplate
