// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/ktx2.h"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/ktx2/files_for_test.h"
#include "zoneplate/codec/ktx2/uastc.h"
#include "zoneplate/image/hash_for_test.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

Rgba8Image decoded(std::span<const std::uint8_t> bytes) { return decode_ktx2(bytes, "tex", 1 << 20).as<Rgba8>(); }

std::string error_of(const Bytes& bytes, std::uint64_t max_pixels = 1 << 20) {
  try {
    decode_ktx2(bytes, "tex", max_pixels);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "no error";
}

TEST(Ktx2, DecodesTheTexelsOfTheReferenceTranscoder) {
  EXPECT_TRUE(is_ktx2(etc1s_file));
  EXPECT_EQ(find_ktx2_size(etc1s_file), (int2{8, 8}));
  // Of the texels by Binomial's transcoder.
  EXPECT_EQ(hash_of(decoded(etc1s_file)), 0xf165f5bef02a6f04u);
  EXPECT_EQ(hash_of(decoded(zstandard_file)), 0xedee8b237f0a8154u);
}

TEST(Ktx2, RefusesWhatItCannotDecode) {
  const Bytes good(std::begin(etc1s_file), std::end(etc1s_file));
  const auto with = [&](std::size_t at, std::uint8_t byte) {
    Bytes bytes = good;
    bytes[at] = byte;
    return error_of(bytes);
  };
  EXPECT_EQ(error_of(good, 63), "tex: has 8 x 8 pixels, more than the limit of 63 (--max-pixels)");
  EXPECT_EQ(with(36, 6), "tex: corrupt KTX2 image: it is a volume, an array or a cube, expected one image");
  EXPECT_EQ(with(12, 43),
            "tex: is a KTX2 image of format 43, model 163 and supercompression 1, expected Basis Universal (ETC1S or "
            "UASTC), BC1 to BC5 or BC7 of unsigned values, BC6H, or uncompressed texels");
  EXPECT_EQ(error_of(Bytes(good.begin(), good.begin() + 60)), "tex: corrupt KTX2 image: it ends early");
  EXPECT_EQ(error_of(Bytes(good.begin(), good.end() - 1)), "tex: corrupt KTX2 image: a part lies outside of the file");
  Bytes damaged(std::begin(zstandard_file), std::end(zstandard_file));
  damaged[damaged[80] + std::size_t{256} * damaged[81]] ^= 0x55;  // the first byte of level 0
  EXPECT_EQ(error_of(damaged), "tex: corrupt KTX2 image: its Zstandard data are damaged");
}

/// Every byte of a file changed in turn: an image or an error of one line.
TEST(Ktx2, ReportsEveryDamage) {
  int refused = 0;
  for (const std::span<const std::uint8_t> file :
       {std::span<const std::uint8_t>(etc1s_file), std::span<const std::uint8_t>(zstandard_file)})
    for (std::size_t at = 12; at < file.size(); ++at)
      for (const int change : {0x01, 0x80, 0xff}) {
        Bytes bytes(file.begin(), file.end());
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ change);
        const std::string message = error_of(bytes);
        EXPECT_EQ(message.find('\n'), std::string::npos);
        refused += message != "no error";
      }
  EXPECT_GT(refused, 300);
}

TEST(Uastc, ASolidBlockIsItsColour) {
  // Mode 8 has the number 0x17 in five bits; the colour follows.
  std::array<std::uint8_t, 16> block{};
  const std::uint64_t bits =
      0x17u | std::uint64_t{10} << 5 | std::uint64_t{20} << 13 | std::uint64_t{30} << 21 | std::uint64_t{40} << 29;
  for (std::size_t i = 0; i < 8; ++i) block[i] = static_cast<std::uint8_t>(bits >> (8 * i));
  const std::string name = "tex";
  for (const Rgba8& texel : ktx2::decode_uastc_block(block, {name})) EXPECT_EQ(texel, (Rgba8{10, 20, 30, 40}));
}

}  // namespace
}  // namespace zoneplate
