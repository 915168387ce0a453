// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/png/deflate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Decompresses a raw DEFLATE stream with zlib; the test fails if the stream is invalid, incomplete or followed by
/// other bytes.
Bytes inflated(const Bytes& stream, std::size_t size) {
  Bytes out(size + 1);
  z_stream z{};
  EXPECT_EQ(inflateInit2(&z, -15), Z_OK);
  z.next_in = const_cast<Bytef*>(stream.data());
  z.avail_in = static_cast<uInt>(stream.size());
  z.next_out = out.data();
  z.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&z, Z_FINISH), Z_STREAM_END) << (z.msg ? z.msg : "");
  EXPECT_EQ(z.avail_in, 0u);
  out.resize(z.total_out);
  inflateEnd(&z);
  return out;
}

Bytes deflated(const Bytes& bytes) {
  Bytes out;
  deflate_part(bytes, true, out);
  return out;
}

/// Bytes below `range`, each repeated a random number of times, at most `longest`.
Bytes noise(std::size_t size, std::uint32_t range, std::uint32_t longest, std::uint32_t seed) {
  Bytes out;
  for (std::uint32_t i = 0; out.size() < size; ++i) {
    const std::uint32_t run = 1 + hash(seed, i, 1) % longest;
    for (std::uint32_t k = 0; k < run && out.size() < size; ++k)
      out.push_back(static_cast<std::uint8_t>(hash(seed, i) % range));
  }
  return out;
}

TEST(Deflate, ZlibReadsEveryLengthOfRun) {
  // One run between other bytes, of each length and at each offset within a word.
  for (std::size_t run = 1; run <= 540; ++run) {
    Bytes bytes(run % 11, 1);
    std::iota(bytes.begin(), bytes.end(), std::uint8_t{2});
    bytes.insert(bytes.end(), run, 200);
    bytes.insert(bytes.end(), {1, 2, 3});
    ASSERT_EQ(inflated(deflated(bytes), bytes.size()), bytes) << run;
  }
}

TEST(Deflate, ZlibReadsNoiseOfAllKinds) {
  for (const std::uint32_t range : {1u, 2u, 3u, 17u, 256u})
    for (const std::uint32_t longest : {1u, 5u, 300u})
      for (const std::size_t size : {0u, 1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 100u, 5000u, 70000u}) {
        const Bytes bytes = noise(size, range, longest, static_cast<std::uint32_t>(size) + range);
        ASSERT_EQ(inflated(deflated(bytes), size), bytes) << range << ' ' << longest << ' ' << size;
      }
}

TEST(Deflate, PartsMakeOneStream) {
  Bytes stream, all;
  for (std::uint32_t part = 0; part < 20; ++part) {
    const Bytes bytes = noise(part * 37, 40, 9, part);
    deflate_part(bytes, part == 19, stream);
    all.insert(all.end(), bytes.begin(), bytes.end());
  }
  EXPECT_EQ(inflated(stream, all.size()), all);
}

TEST(Deflate, RunsCostNextToNothingAndNoiseLittleMoreThanItself) {
  EXPECT_LT(deflated(Bytes(131072, 0)).size(), 200u);
  EXPECT_LT(deflated(noise(131072, 256, 1, 3)).size(), 131072u + 400u);
  // The entropy is two bits per byte; encoding runs of four as runs, which pays for other data, costs an eighth here.
  EXPECT_LT(deflated(noise(131072, 4, 1, 3)).size(), 131072u / 4 * 9 / 8);
}

/// The sum of 2^-length over all codes, in units of 2^-32: 2^32 for a complete code.
std::uint64_t kraft_sum(const std::vector<std::uint8_t>& lengths) {
  std::uint64_t sum = 0;
  for (const std::uint8_t length : lengths)
    if (length) sum += std::uint64_t{1} << (32 - length);
  return sum;
}

TEST(HuffmanLengths, AreTheBestOnes) {
  // An example by Cormen et al.: 45 13 12 16 9 5 takes 224 bits.
  const std::vector<std::uint32_t> counts = {45, 13, 12, 0, 16, 9, 5};
  std::vector<std::uint8_t> lengths(7);
  huffman_lengths(counts, 15, lengths);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 7; ++i) bits += counts[i] * lengths[i];
  EXPECT_EQ(bits, 224u);
  EXPECT_EQ(lengths[3], 0);
  EXPECT_EQ(kraft_sum(lengths), std::uint64_t{1} << 32);
}

TEST(HuffmanLengths, KeepTheLimit) {
  // Fibonacci numbers give the deepest tree.
  std::vector<std::uint32_t> counts = {1, 1};
  while (counts.size() < 40) counts.push_back(counts[counts.size() - 1] + counts[counts.size() - 2]);
  for (const int limit : {6, 7, 14, 15, 39}) {
    std::vector<std::uint8_t> lengths(counts.size());
    huffman_lengths(counts, limit, lengths);
    EXPECT_LE(*std::max_element(lengths.begin(), lengths.end()), limit);
    EXPECT_EQ(kraft_sum(lengths), std::uint64_t{1} << 32) << limit;
  }
  std::vector<std::uint8_t> one(5);
  huffman_lengths(std::vector<std::uint32_t>{0, 0, 7, 0, 0}, 14, one);
  EXPECT_EQ(one, (std::vector<std::uint8_t>{0, 0, 1, 0, 0}));
}

TEST(Deflate, ManyDepthsOfCode) {
  // Fibonacci counts need codes longer than the limit; zlib must accept the limited code as complete.
  Bytes bytes;
  std::size_t a = 1, b = 1;
  for (std::uint8_t symbol = 0; symbol < 22; ++symbol) {
    for (std::size_t i = 0; i < a; ++i) bytes.push_back(symbol);
    a = std::exchange(b, a + b);
  }
  for (std::size_t i = bytes.size(); i-- > 1;)
    std::swap(bytes[i], bytes[hash(7, static_cast<std::uint32_t>(i)) % (i + 1)]);
  EXPECT_EQ(inflated(deflated(bytes), bytes.size()), bytes);
}

}  // namespace
}  // namespace zoneplate
