// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/png/deflate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace zoneplate {
namespace {

constexpr std::size_t shortest_run = 4, longest_run = 258;  // a run of three is encoded as three literals
constexpr std::size_t end_of_block = 256, first_length = 257, literal_symbols = 286;
// The limit allows four literals and up to seven pending bits in 64 bits.
constexpr int longest_literal_code = 14;

/// A Huffman code as it is appended: bit-reversed, because DEFLATE stores Huffman codes from their most significant
/// bit.
struct Code {
  std::uint16_t bits = 0;
  std::uint8_t length = 0;
};

class BitWriter {
 public:
  /// Requires  capacity for all bits that will be put, and eight bytes more.
  explicit BitWriter(std::uint8_t* at) : at_(at) {}

  /// Requires  length <= 56.
  void put(std::uint64_t bits, int length) {
    waiting_ |= bits << count_;
    count_ += length;
    static_assert(std::endian::native == std::endian::little);
    std::memcpy(at_, &waiting_, sizeof waiting_);
    at_ += count_ >> 3;
    waiting_ >>= count_ & ~7;
    count_ &= 7;
  }
  void put(Code code) { put(code.bits, code.length); }
  std::uint8_t* end_of_byte() {
    if (count_ > 0) put(0, 8 - count_);
    return at_;
  }

 private:
  std::uint8_t* at_;
  std::uint64_t waiting_ = 0;
  int count_ = 0;
};

/// A number of literals, followed by a number of repetitions of the last one.
struct Piece {
  std::uint32_t literals, run;
};

std::uint64_t word_at(const std::uint8_t* p) {
  std::uint64_t word;
  std::memcpy(&word, p, sizeof word);
  return word;
}

/// The index of the first run of repetitions at or after `from`, or `size`.
std::size_t find_run(const std::uint8_t* p, std::size_t from, std::size_t size) {
  constexpr std::uint64_t ones = 0x0101010101010101u, high = ones << 7;
  std::size_t i = std::max<std::size_t>(from, 1);
  // Compares eight bytes with their predecessors: a byte of `same` is 0x80 where they are equal.
  for (; i + 8 <= size; i += 9 - shortest_run) {
    const std::uint64_t differ = word_at(p + i) ^ word_at(p + i - 1);
    const std::uint64_t same = ~(((differ & ~high) + ~high) | differ) & high;
    const std::uint64_t run = same & (same >> 8) & (same >> 16) & (same >> 24);
    if (run != 0) return i + static_cast<std::size_t>(std::countr_zero(run) / 8);
  }
  for (; i + shortest_run <= size; ++i)
    if (p[i] == p[i - 1] && p[i + 1] == p[i - 1] && p[i + 2] == p[i - 1] && p[i + 3] == p[i - 1]) return i;
  return size;
}

std::size_t end_of_run(const std::uint8_t* p, std::size_t from, std::size_t size) {
  std::size_t i = from;
  for (; i + 8 <= size; i += 8)
    if (const std::uint64_t differ = word_at(p + i) ^ word_at(p + i - 1); differ != 0)
      return i + static_cast<std::size_t>(std::countr_zero(differ) / 8);
  while (i < size && p[i] == p[i - 1]) ++i;
  return i;
}

std::vector<Piece> find_pieces(std::span<const std::uint8_t> bytes) {
  std::vector<Piece> pieces;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t first = find_run(bytes.data(), at, bytes.size());
    const std::size_t last = first == bytes.size() ? first : end_of_run(bytes.data(), first, bytes.size());
    pieces.push_back({static_cast<std::uint32_t>(first - at), static_cast<std::uint32_t>(last - first)});
    at = last;
  }
  return pieces;
}

/// The encoding of a length between 3 and 258: its symbol and the extra bits.
struct RunLength {
  std::uint16_t symbol;
  std::uint8_t extra_bits, extra;
};

constexpr std::array<RunLength, longest_run + 1> make_run_lengths() {
  std::array<RunLength, longest_run + 1> out{};
  std::size_t length = 3;
  for (std::uint16_t symbol = first_length; symbol < 285; ++symbol) {
    const int bits = symbol < 265 ? 0 : (symbol - 261) / 4;
    for (int extra = 0; extra < 1 << bits && length < longest_run; ++extra, ++length)
      out[length] = {symbol, static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(extra)};
  }
  out[longest_run] = {285, 0, 0};
  return out;
}
constexpr std::array<RunLength, longest_run + 1> run_lengths = make_run_lengths();

/// Splits a run into lengths between 3 and 258 and calls use(length) for each.
template <class Use>
void cut_run(std::size_t run, Use use) {
  while (run > 0) {
    // The remainder after the last full length must not be shorter than 3.
    const std::size_t length = run <= longest_run ? run : run < longest_run + 3 ? run - 3 : longest_run;
    use(length);
    run -= length;
  }
}

using Counts = std::array<std::uint32_t, literal_symbols>;

Counts count_symbols(std::span<const std::uint8_t> bytes, const std::vector<Piece>& pieces) {
  // Four tables, so that increments of the same symbol do not depend on each other.
  std::uint32_t literals[4][256] = {};
  Counts counts{};
  const std::uint8_t* p = bytes.data();
  for (const Piece& piece : pieces) {
    std::uint32_t i = 0;
    for (; i + 4 <= piece.literals; i += 4)
      ++literals[0][p[i]], ++literals[1][p[i + 1]], ++literals[2][p[i + 2]], ++literals[3][p[i + 3]];
    for (; i < piece.literals; ++i) ++literals[0][p[i]];
    cut_run(piece.run, [&](std::size_t length) { ++counts[run_lengths[length].symbol]; });
    p += piece.literals + piece.run;
  }
  for (std::size_t i = 0; i < 256; ++i) counts[i] = literals[0][i] + literals[1][i] + literals[2][i] + literals[3][i];
  counts[end_of_block] = 1;
  return counts;
}

/// Assigns canonical codes to lengths: shorter codes first, equal lengths in the order of their symbols.
void make_codes(std::span<const std::uint8_t> lengths, std::span<Code> codes) {
  // next[i] is first the number of codes of length i - 1, then the next code of length i.
  std::array<std::uint32_t, 17> next{};
  for (const std::uint8_t length : lengths) ++next[length + 1u];
  next[1] = 0;
  for (std::size_t length = 1; length < next.size(); ++length) next[length] = 2 * (next[length] + next[length - 1]);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const std::uint32_t length = lengths[i];
    if (length == 0) continue;
    std::uint32_t value = next[length]++, reversed = 0;
    for (std::uint32_t bit = 0; bit < length; ++bit) reversed |= (value >> bit & 1) << (length - 1 - bit);
    codes[i] = {static_cast<std::uint16_t>(reversed), static_cast<std::uint8_t>(length)};
  }
}

/// The code lengths in front of a block: they are Huffman-coded themselves, with runs of zeros.
class LengthTable {
 public:
  explicit LengthTable(std::span<const std::uint8_t> lengths) {
    for (std::size_t i = 0; i < lengths.size();) {
      std::size_t end = i;
      while (end < lengths.size() && lengths[end] == lengths[i] && end - i < 138) ++end;
      if (lengths[i] != 0 || end - i < 3) {
        add(lengths[i++], 0, 0);
        continue;
      }
      const auto zeros = static_cast<std::uint8_t>(end - i);
      zeros < 11 ? add(17, static_cast<std::uint8_t>(zeros - 3), 3) : add(18, static_cast<std::uint8_t>(zeros - 11), 7);
      i = end;
    }
  }

  void write(BitWriter& out) const {
    constexpr std::size_t order[] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    std::array<std::uint32_t, 19> counts{};
    for (const Entry& e : entries_) ++counts[e.symbol];
    std::array<std::uint8_t, 19> lengths{};
    huffman_lengths(counts, 7, lengths);
    // Decoders require this code to be complete as well.
    if (std::count(lengths.begin(), lengths.end(), 0) == 18) lengths[lengths[0] == 0 ? 0 : 1] = 1;
    std::array<Code, 19> codes{};
    make_codes(lengths, codes);
    std::size_t used = 19;
    while (used > 4 && lengths[order[used - 1]] == 0) --used;
    out.put(used - 4, 4);
    for (std::size_t i = 0; i < used; ++i) out.put(lengths[order[i]], 3);
    for (const Entry& e : entries_) {
      out.put(codes[e.symbol]);
      out.put(e.extra, e.extra_bits);
    }
  }

 private:
  struct Entry {
    std::uint8_t symbol, extra, extra_bits;
  };
  void add(std::uint8_t symbol, std::uint8_t extra, std::uint8_t bits) { entries_.push_back({symbol, extra, bits}); }
  std::vector<Entry> entries_;
};

void write_pieces(std::span<const std::uint8_t> bytes, const std::vector<Piece>& pieces,
                  const std::array<Code, literal_symbols>& codes, BitWriter& out) {
  const std::uint8_t* p = bytes.data();
  for (const Piece& piece : pieces) {
    std::uint32_t i = 0;
    for (; i + 4 <= piece.literals; i += 4) {
      const Code a = codes[p[i]], b = codes[p[i + 1]], c = codes[p[i + 2]], d = codes[p[i + 3]];
      const std::uint64_t ab = a.bits | std::uint64_t{b.bits} << a.length;
      const std::uint64_t cd = c.bits | std::uint64_t{d.bits} << c.length;
      const int of_ab = a.length + b.length;
      out.put(ab | cd << of_ab, of_ab + c.length + d.length);
    }
    for (; i < piece.literals; ++i) out.put(codes[p[i]]);
    cut_run(piece.run, [&](std::size_t length) {
      const RunLength& run = run_lengths[length];
      const Code code = codes[run.symbol];
      // The only distance is 1; its code is a single 0 bit.
      out.put(code.bits | std::uint64_t{run.extra} << code.length, code.length + run.extra_bits + 1);
    });
    p += piece.literals + piece.run;
  }
  out.put(codes[end_of_block]);
}

}  // namespace

void huffman_lengths(std::span<const std::uint32_t> counts, int limit, std::span<std::uint8_t> lengths) {
  struct Node {
    std::uint64_t count;
    std::uint32_t symbol, parent;
  };
  std::array<Node, 1024> node;
  std::fill(lengths.begin(), lengths.end(), std::uint8_t{0});
  for (int halvings = 0;; ++halvings) {
    std::size_t leaves = 0;
    for (std::uint32_t i = 0; i < counts.size(); ++i)
      if (counts[i] > 0) node[leaves++] = {(counts[i] >> halvings) | 1u, i, 0};
    if (leaves == 0) return;
    if (leaves == 1) {
      lengths[node[0].symbol] = 1;
      return;
    }
    std::sort(node.begin(), node.begin() + static_cast<std::ptrdiff_t>(leaves), [](const Node& p, const Node& q) {
      return p.count != q.count ? p.count < q.count : p.symbol < q.symbol;
    });

    // Merges the two smallest of the leaves and of the inner nodes; both sequences are sorted by count.
    std::size_t leaf = 0, sum = leaves, end = leaves;
    const auto take = [&] {
      const bool is_leaf = sum == end || (leaf < leaves && node[leaf].count <= node[sum].count);
      const std::size_t taken = is_leaf ? leaf++ : sum++;
      node[taken].parent = static_cast<std::uint32_t>(end);
      return node[taken].count;
    };
    while (end < 2 * leaves - 1) {
      const std::uint64_t first = take();
      // take() does not see node[end] yet, because its index is `end`.
      node[end].count = first + take();
      ++end;
    }

    // Replaces counts by depths. A parent precedes its children in this order, so that its count is its depth already.
    node[end - 1].count = 0;
    std::uint64_t deepest = 0;
    for (std::size_t i = end - 1; i-- > 0;) {
      node[i].count = node[node[i].parent].count + 1;
      deepest = std::max(deepest, node[i].count);
    }
    if (deepest > static_cast<std::uint64_t>(limit)) continue;
    for (std::size_t i = 0; i < leaves; ++i) lengths[node[i].symbol] = static_cast<std::uint8_t>(node[i].count);
    return;
  }
}

void deflate_part(std::span<const std::uint8_t> bytes, bool is_last, std::vector<std::uint8_t>& out) {
  const std::vector<Piece> pieces = find_pieces(bytes);
  const Counts counts = count_symbols(bytes, pieces);
  std::array<std::uint8_t, literal_symbols + 1> lengths{};
  huffman_lengths(counts, longest_literal_code, std::span(lengths).first(literal_symbols));
  std::array<Code, literal_symbols> codes{};
  make_codes(std::span(lengths).first(literal_symbols), codes);

  // The size is computed in advance, so that writes need no bounds check.
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < literal_symbols; ++i)
    bits += std::uint64_t{counts[i]} * (lengths[i] + (i > 256 ? 6u : 0u));
  constexpr std::size_t header_room = 1024;
  const std::size_t before = out.size();
  out.resize(before + bits / 8 + header_room);

  std::size_t used = literal_symbols;
  while (lengths[used - 1] == 0) --used;
  const bool has_runs = used > first_length;
  lengths[used] = has_runs ? 1 : 0;  // the length of the distance code
  BitWriter writer(out.data() + before);
  writer.put(is_last ? 1 : 0, 1);
  writer.put(2, 2);
  writer.put(used - 257, 5);
  writer.put(0, 5);
  LengthTable(std::span(lengths).first(used + 1)).write(writer);
  write_pieces(bytes, pieces, codes, writer);
  if (!is_last) {
    // An empty stored block aligns the output to a byte.
    writer.put(0, 3);
    writer.end_of_byte();
    writer.put(0xffff0000u, 32);
  }
  out.resize(static_cast<std::size_t>(writer.end_of_byte() - out.data()));
}

}  // namespace zoneplate
