// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/bc6h.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "zoneplate/image/half.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::array<float4, 16> decoded(const Bytes& block, bool is_signed) {
  const std::string name = "tex";
  return ktx2::decode_bc6h_block(block, is_signed, {name});
}

TEST(Bc6h, HasTheTexelsOfAnotherDecoder) {
  // FNV-1a of the halves of 1400 blocks, 100 of each mode, of pseudorandom bits: that of bcdec 0.98.
  constexpr std::uint8_t codes[14] = {0, 1, 2, 6, 10, 14, 18, 22, 26, 30, 3, 7, 11, 15};
  for (const bool is_signed : {false, true}) {
    std::uint64_t sum = 14695981039346656037u;
    for (std::uint32_t n = 0; n < 1400; ++n) {
      Bytes block;
      for (std::uint32_t i = 0; i < 16; ++i) block.push_back(static_cast<std::uint8_t>(hash(n, i)));
      const std::uint8_t code = codes[n % 14], mask = code < 2 ? 3 : 31;
      block[0] = static_cast<std::uint8_t>((block[0] & ~mask) | code);
      for (const float4& p : decoded(block, is_signed)) {
        EXPECT_EQ(p.w, 1);
        for (const float v : {p.x, p.y, p.z})
          for (const int shift : {0, 8}) sum = (sum ^ (half_bits(v) >> shift & 255u)) * 1099511628211u;
      }
    }
    EXPECT_EQ(sum, is_signed ? 0x0c5135990c1c6f73u : 0x422a03fc72b037ceu) << is_signed;
  }
}

TEST(Bc6h, ReservedModesAreBlack) {
  for (const int code : {0b10011, 0b10111, 0b11011, 0b11111}) {
    Bytes block(16, 0xff);
    block[0] = static_cast<std::uint8_t>(0xe0 | code);
    for (const float4& p : decoded(block, false)) EXPECT_EQ(p, (float4{0, 0, 0, 1}));
  }
}

}  // namespace
}  // namespace zoneplate
