// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/color_space.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "zoneplate/codec/color/icc_for_test.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/inspect/exif_for_test.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/png/png_chunk.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/os/library.h"

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
}

TEST(ColorSpace, OrientationsAreReadFromExif) {
  const Bytes png = encode_png(Rgba8Image(2, 2)), jpeg = encode_jpeg(Rgba8Image(2, 2));
  const auto webp_with = [&](const Bytes& exif) {
    Bytes webp = encode_webp(Rgba8Image(2, 2), false);
    for (const std::string_view text : {std::string_view("EXIF"), std::string_view("\0\0\0\0", 4)})
      webp.insert(webp.end(), text.begin(), text.end());
    webp[webp.size() - 4] = static_cast<std::uint8_t>(exif.size());
    webp.insert(webp.end(), exif.begin(), exif.end());
    return webp;
  };
  for (std::uint8_t i = 1; i <= 8; ++i) {
    EXPECT_EQ(read_file_color(png_with(png, "eXIf", exif_of(i))).orientation, i);
    EXPECT_EQ(read_file_color(turned_jpeg(jpeg, i)).orientation, i);
    EXPECT_EQ(read_file_color(webp_with(exif_of(i))).orientation, i);
  }
  Bytes prefixed = {'E', 'x', 'i', 'f', 0, 0};
  const Bytes turned = exif_of(6);
  prefixed.insert(prefixed.end(), turned.begin(), turned.end());
  EXPECT_EQ(read_file_color(webp_with(prefixed)).orientation, 6);
  for (const std::uint8_t wrong : Bytes{0, 9, 255}) EXPECT_EQ(read_file_color(turned_jpeg(jpeg, wrong)).orientation, 1);
  for (std::size_t size = 0; size < turned.size(); ++size)
    read_file_color(png_with(png, "eXIf", Bytes(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(size))));
}

// Bytes of 0xff before a marker fill up, and a marker may stand without a segment.
TEST(ColorSpace, FillBytesOfJpegAreSkipped) {
  const Bytes icc = icc_display_p3();
  const Bytes plain = turned_jpeg(encode_jpeg(Rgba8Image(2, 2), 90, icc), 6);
  for (const Bytes& fill : {Bytes{0xff}, Bytes(300, 0xff), Bytes{0xff, 0x01}, Bytes{0x00, 0x17, 0xff}}) {
    Bytes jpeg = {plain[0], plain[1]};
    for (std::size_t at = 2; at + 4 < plain.size() && plain[at + 1] != 0xda;) {
      const std::size_t size = 2 + (std::size_t{plain[at + 2]} << 8 | plain[at + 3]);
      if (at > 2 || fill[0] == 0xff) jpeg.insert(jpeg.end(), fill.begin(), fill.end());
      jpeg.insert(jpeg.end(), &plain[at], &plain[at] + size);
      at += size;
    }
    EXPECT_EQ(read_file_color(jpeg).profile.icc, icc) << fill.size();
    EXPECT_EQ(read_file_color(jpeg).orientation, 6);
    for (std::size_t size = 0; size < jpeg.size(); size += 7)
      read_file_color(std::span(jpeg).first(size));  // reads no byte behind
  }
}

TEST(ColorSpace, WrittenProfilesAreRead) {
  const Rgba8Image image(2, 2);
  const Bytes icc = icc_display_p3();
  const std::array<std::uint32_t, 8> primaries = {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000};
  const ColorProfile all{.cicp = {{12, 13, 0, 1}}, .icc = icc, .gamma = 45455, .primaries = primaries};
  EXPECT_EQ(read_file_color(encode_png(image, {.profile = all})).profile, all);
  EXPECT_EQ(read_file_color(encode_png(Rgba16Image(2, 2), {.profile = all})).profile, all);
  EXPECT_EQ(read_file_color(encode_png(image, {.is_small = true, .profile = all})).profile, all);
  EXPECT_EQ(read_file_color(encode_jpeg(image, 90, icc)).profile, ColorProfile{.icc = icc});
  EXPECT_EQ(read_file_color(encode_webp(image, true, std::nullopt, icc)).profile, ColorProfile{.icc = icc});
  // A profile that takes several segments of a JPEG.
  Bytes large = icc;
  large.resize(200'000);
  EXPECT_EQ(read_file_color(encode_jpeg(image, 90, large)).profile.icc, large);
}

TEST(ColorSpace, ProfilesThatMeanNothingAreFlaws) {
  const auto flaw = [](const Bytes& file) { return read_image_color(file, "a").flaw; };
  const Rgba8Image image(2, 2);
  EXPECT_EQ(flaw(encode_png(image, {.profile = {.cicp = {{1, 99, 0, 1}}}})),
            "a: its cICP chunk has transfer function 99, which is not read; the image is taken as sRGB");
  EXPECT_EQ(flaw(encode_png(image, {.profile = {.gamma = 0}})),
            "a: its gAMA chunk has the value 0, expected 1000 to 10000000; the image is taken as sRGB");
  const ExrChromaticities wrong = {0, 0, 0, 0, 0, 0, 0, 0};
  const LinearImage light(2, 2);
  EXPECT_EQ(flaw(encode_exr(2, 2, rgba_channels(light), {{"chromaticities", wrong}})),
            "a: its chromaticities attribute has primaries or a white of no colour; the image is taken as light of "
            "Rec.709 primaries");
  const Bytes png = encode_png(image, {.is_srgb = false});
  EXPECT_EQ(flaw(png_with(png, "iCCP", {'a', 0, 0, 1, 2, 3})),
            "a: its ICC profile is damaged: its packed bytes are no whole zlib stream; the image is taken as sRGB");
  EXPECT_EQ(flaw(png_with(png, "iCCP", {'a'})), "a: its ICC profile is cut off; the image is taken as sRGB");
  EXPECT_EQ(flaw(png), "");
  if (!open_library(Library::Lcms)) GTEST_SKIP() << "liblcms2-2 is not installed";
  Bytes icc = icc_display_p3();
  EXPECT_EQ(flaw(encode_png(image, {.profile = {.icc = icc}})), "");
  EXPECT_EQ(read_image_color(encode_png(image, {.profile = {.icc = icc}}), "a").space->name,
            "the ICC profile 'Display P3'");
  icc.resize(5'000'000);
  EXPECT_EQ(flaw(encode_png(image, {.profile = {.icc = icc}})),
            "a: its ICC profile has more than 4194304 bytes, which are not read; the image is taken as sRGB");
  EXPECT_EQ(flaw(encode_jpeg(image, 90, Bytes(300, 7))),
            "a: its ICC profile has no header; the image is taken as sRGB");
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
