// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/color_space.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "zoneplate/codec/exr_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/png/png_chunk.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A PNG with these chunks after its header, and without an sRGB chunk.
std::string space_of_png(const std::vector<std::pair<std::string, Bytes>>& chunks) {
  const Bytes plain = encode_png(Rgba8Image(2, 2), {.is_srgb = false});
  constexpr std::size_t header = 8 + 25;
  Bytes file(plain.begin(), plain.begin() + header);
  for (const auto& [name, data] : chunks) put_png_chunk(file, name, data);
  file.insert(file.end(), plain.begin() + header, plain.end());
  return color_space_of(file);
}

Bytes words(const std::vector<std::uint32_t>& values) {
  Bytes out;
  for (const std::uint32_t value : values) put_png_word(out, value);
  return out;
}

Bytes profile_chunk(int level) {
  const Bytes profile(500, 7);
  uLongf size = compressBound(profile.size());
  Bytes packed(size);
  compress2(packed.data(), &size, profile.data(), profile.size(), level);
  Bytes out = {'P', '3', 0, 0};
  out.insert(out.end(), packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
  return out;
}

TEST(ColorSpace, FilesThatSayNothingAreSrgb) {
  EXPECT_EQ(color_space_of(encode_png(Rgba8Image(2, 2))), "");
  EXPECT_EQ(space_of_png({}), "");
  EXPECT_EQ(space_of_png({{"gAMA", words({45455})}}), "");
  EXPECT_EQ(space_of_png(
                {{"gAMA", words({45455})}, {"cHRM", words({31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000})}}),
            "");
  EXPECT_EQ(space_of_png({{"cICP", {1, 13, 0, 1}}}), "");
  EXPECT_EQ(color_space_of(encode_pfm(LinearImage(2, 2))), "");
  EXPECT_EQ(color_space_of({}), "");
}

TEST(ColorSpace, ChunksOfPngAreRead) {
  EXPECT_EQ(space_of_png({{"gAMA", words({100000})}}), "gAMA 1");
  EXPECT_EQ(space_of_png({{"cICP", {9, 16, 0, 1}}}), "cICP 9/16/0/1");
  EXPECT_EQ(space_of_png({{"cICP", {1, 13, 0, 1}}, {"gAMA", words({100000})}}), "");  // cICP counts first
  EXPECT_EQ(space_of_png({{"sRGB", {0}}, {"gAMA", words({100000})}}), "");
  EXPECT_TRUE(space_of_png({{"cHRM", words({1, 2, 3, 4, 5, 6, 7, 8})}}).starts_with("cHRM 1e-05"));
  const std::string profile = space_of_png({{"iCCP", profile_chunk(1)}});
  EXPECT_TRUE(profile.starts_with("ICC profile of 500 bytes")) << profile;
  EXPECT_EQ(space_of_png({{"iCCP", profile_chunk(9)}}), profile);  // however it is packed
  const Bytes turned = {'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 0x12, 0, 3, 0, 0, 0, 1, 0, 6, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(space_of_png({{"eXIf", turned}}), "Exif orientation 6");
  for (std::size_t size = 0; size < turned.size(); ++size)
    space_of_png({{"eXIf", Bytes(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(size))}});
}

TEST(ColorSpace, OtherFormatsStateTheirs) {
  const LinearImage light(2, 2);
  const ExrChromaticities wide = {0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f};
  EXPECT_EQ(color_space_of(encode_exr(2, 2, rgba_channels(light), {{"chromaticities", rec709_chromaticities}})), "");
  EXPECT_TRUE(color_space_of(encode_exr(2, 2, rgba_channels(light), {{"chromaticities", wide}}))
                  .starts_with("chromaticities 0.7347 "));
  const auto of_text = [](std::string_view text) {
    return color_space_of({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(of_text("Pf\n2 1\n-2.0\n12345678"), "scale 2");
  EXPECT_EQ(of_text("#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n"), "EXPOSURE=2");
  Bytes jpeg = {0xff, 0xd8, 0xff, 0xe2, 0,   20, 'I', 'C', 'C', '_', 'P', 'R',
                'O',  'F',  'I',  'L',  'E', 0,  1,   1,   9,   9,   9,   9};
  EXPECT_TRUE(color_space_of(jpeg).starts_with("ICC profile of 4 bytes")) << color_space_of(jpeg);
}

}  // namespace
}  // namespace zoneplate
