// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/uncompressed.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/ktx2/ktx2.h"
#include "zoneplate/image/half.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put(Bytes& out, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// A file of one level in a format of Vulkan's number.
Bytes ktx2_file(std::uint32_t format, std::uint32_t width, std::uint32_t height, const Bytes& level) {
  constexpr std::uint32_t descriptor = 44;
  Bytes file{0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
  for (const std::uint32_t word : {format, 1u, width, height, 0u, 0u, 1u, 1u, 0u, 104u, descriptor, 0u, 0u})
    put(file, word, 4);
  put(file, 0, 8), put(file, 0, 8), put(file, 148, 8), put(file, level.size(), 8), put(file, level.size(), 8);
  file.resize(148);
  file.insert(file.end(), level.begin(), level.end());
  return file;
}

TexelImage decoded(std::uint32_t format, std::uint32_t width, const Bytes& level) {
  return decode_ktx2(ktx2_file(format, width, 1, level), "tex", 100);
}

TEST(UncompressedKtx2, CodesKeepTheirOrderAndMissingChannelsAreBlack) {
  Rgba8Image two(2, 1, {1, 2, 3, 4});
  two(1, 0) = {5, 6, 7, 8};
  EXPECT_EQ(decoded(37, 2, {1, 2, 3, 4, 5, 6, 7, 8}), TexelImage(two));  // R8G8B8A8_UNORM
  EXPECT_EQ(decoded(50, 2, {3, 2, 1, 4, 7, 6, 5, 8}), TexelImage(two));  // B8G8R8A8_SRGB
  EXPECT_EQ(decoded(29, 1, {1, 2, 3}), TexelImage(Rgba8Image(1, 1, {1, 2, 3, 255})));
  EXPECT_EQ(decoded(9, 1, {9}), TexelImage(Rgba8Image(1, 1, {9, 0, 0, 255})));
  EXPECT_EQ(decoded(77, 1, {1, 2, 3, 4}), TexelImage(Rgba16Image(1, 1, {0x0201, 0x0403, 0, 65535})));
}

TEST(UncompressedKtx2, FloatsAreLight) {
  Bytes halves, floats;
  for (const float v : {0.5f, 65504.0f, -2.0f, 0.25f}) put(halves, half_bits(v), 2);
  for (const float v : {1e-7f, 1e9f, 3.0f}) put(floats, std::bit_cast<std::uint32_t>(v), 4);
  EXPECT_EQ(decoded(97, 1, halves), TexelImage(Plane<float4>(1, 1, float4{0.5f, 65504, -2, 0.25f})));
  EXPECT_EQ(decoded(106, 1, floats), TexelImage(Plane<float4>(1, 1, float4{1e-7f, 1e9f, 3, 1})));
}

TEST(UncompressedKtx2, PackedFloatsHaveTheirValues) {
  // 1.5 = 2^0 (1 + 32/64), 0.25 = 2^-2, 3 = 2^1 (1 + 16/32): exponents are biased by 15.
  Bytes eleven, shared;
  put(eleven, (15u << 6 | 32u) | (13u << 6) << 11 | (16u << 5 | 16u) << 22, 4);
  EXPECT_EQ(decoded(122, 1, eleven), TexelImage(Plane<float4>(1, 1, float4{1.5f, 0.25f, 3, 1})));
  // 256, 128 and 1 times 2^(17 - 24).
  put(shared, 256u | 128u << 9 | 1u << 18 | 17u << 27, 4);
  EXPECT_EQ(decoded(123, 1, shared), TexelImage(Plane<float4>(1, 1, float4{2, 1, 0x1p-7f, 1})));
}

TEST(UncompressedKtx2, LevelsHaveTheSizeOfTheirTexels) {
  EXPECT_THROW(decoded(37, 2, {1, 2, 3, 4, 5, 6, 7}), Error);
  EXPECT_EQ(ktx2_texel_memory(ktx2_file(97, 1, 1, {})), sizeof(float4));
  EXPECT_EQ(ktx2_texel_memory(ktx2_file(143, 1, 1, {})), sizeof(float4));
  EXPECT_EQ(ktx2_texel_memory(ktx2_file(91, 1, 1, {})), sizeof(Rgba16));
  EXPECT_EQ(ktx2_texel_memory(ktx2_file(43, 1, 1, {})), sizeof(Rgba8));
}

}  // namespace
}  // namespace zoneplate
