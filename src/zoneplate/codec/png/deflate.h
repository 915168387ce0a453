// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace zoneplate {

/// Appends one part of a DEFLATE stream: a block of `bytes` with its own Huffman code.
///
/// The only repetitions that are encoded are runs of one byte, which are most of the filtered rows of a rendered image;
/// this is about ten times as fast as a general search. The part ends at a byte boundary, so that parts from several
/// threads can be concatenated; the part with `is_last` ends the stream.
///
/// Requires  at most 2^24 bytes.
/// Source    Deutsch, DEFLATE Compressed Data Format Specification, RFC 1951, 1996.
void deflate_part(std::span<const std::uint8_t> bytes, bool is_last, std::vector<std::uint8_t>& out);

/// The code lengths in bits of a Huffman code for symbols with these counts, at most `limit`; 0 where the count is 0.
///
/// A single symbol has length 1.
///
/// Exact     the same lengths for the same counts. The code is complete, and optimal unless a length would exceed the
///           limit; in that case counts are halved until none does.
/// Requires  2^limit >= the number of symbols with a count; counts.size() == lengths.size() <= 512.
void huffman_lengths(std::span<const std::uint32_t> counts, int limit, std::span<std::uint8_t> lengths);

}  // namespace zoneplate
