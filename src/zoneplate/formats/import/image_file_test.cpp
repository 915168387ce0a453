// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/image_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp_still.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::string decode_error(const Bytes& bytes) {
  try {
    decode_image(bytes, "tex", 100);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    return e.what();
  }
  return "no error";
}

TEST(ImageFile, PngByItsFirstBytes) {
  Rgba8Image image(3, 2, {1, 2, 3, 4});
  image(2, 1) = {250, 251, 252, 253};
  const Bytes bytes = encode_png(image);
  EXPECT_EQ(find_image_size(bytes), (int2{3, 2}));
  EXPECT_EQ(decode_image(bytes, "tex", 100).texels, image);
  EXPECT_THROW(decode_image(bytes, "tex", 5), Error);
}

TEST(ImageFile, SixteenBitsAreKept) {
  Rgba16Image image(2, 1);
  image(0, 0) = {0, 65535, 128, 129};
  image(1, 0) = {257, 385, 386, 65535};
  const Bytes bytes = encode_png(image);
  EXPECT_EQ(decode_image(bytes, "tex", 100).texels, image);
  EXPECT_EQ(decoded_image_memory(bytes), 2 * sizeof(Rgba16));
  EXPECT_EQ(decoded_image_memory(encode_png(Rgba8Image(2, 1))), 2 * sizeof(Rgba8));
  Plane<std::uint16_t> grey(1, 1, 1000);
  EXPECT_EQ(decode_image(encode_png(grey), "tex", 100).texels, Rgba16Image(1, 1, {1000, 1000, 1000, 65535}));
}

TEST(ImageFile, SizeOfAJpegIsWhatLibjpegReadsUpToTheFirstScan) {
  const Bytes whole = encode_jpeg(Rgba8Image(517, 258));
  const Bytes scan{0xff, 0xda};
  const auto start =
      static_cast<std::size_t>(std::search(whole.begin(), whole.end(), scan.begin(), scan.end()) - whole.begin());
  const std::size_t header = start + 2 + whole[start + 3];
  EXPECT_EQ(find_image_size(std::span(whole).first(header)), (int2{517, 258}));
  // Of the scan's header the last bytes may be missing: the size is known, and the image is refused.
  for (std::size_t n = 0; n < header - 4; ++n) EXPECT_FALSE(find_image_size(std::span(whole).first(n))) << n;
  // A second frame header, which the decoder rejects, gives no size either, because the same parser reads both.
  const Bytes frame{0xff, 0xc0};
  const auto first = std::search(whole.begin(), whole.end(), frame.begin(), frame.end());
  Bytes twice = whole;
  twice.insert(twice.begin() + (first - whole.begin()), first, first + 19);
  EXPECT_NE(decode_error(twice), "no error");
  EXPECT_FALSE(find_image_size(twice));
}

TEST(ImageFile, LightIsKept) {
  const std::string head = "#?RADIANCE\n\n-Y 1 +X 1\n";
  Bytes hdr(head.begin(), head.end());
  hdr.insert(hdr.end(), {128, 8, 0, 150});                     // 2^21, 2^17, 0
  const LinearImage light(1, 1, {1e4f, 0.125f, -0.5f, 0.5f});  // premultiplied
  const Linear& first = light.values()[0];
  const Bytes exr = encode_exr(1, 1,
                               {{"R", ExrType::Float, &first.r, nullptr, 4},
                                {"G", ExrType::Float, &first.g, nullptr, 4},
                                {"B", ExrType::Float, &first.b, nullptr, 4},
                                {"A", ExrType::Float, &first.a, nullptr, 4}});
  EXPECT_EQ(find_image_size(hdr), (int2{1, 1}));
  EXPECT_EQ(find_image_size(exr), (int2{1, 1}));
  EXPECT_EQ(decode_image(hdr, "tex", 4).texels, Plane<float4>(1, 1, float4{0x1p21f, 0x1p17f, 0, 1}));
  EXPECT_EQ(decode_image(exr, "tex", 4).texels, Plane<float4>(1, 1, float4{2e4f, 0.25f, -1, 0.5f}));
  EXPECT_EQ(decoded_image_memory(hdr), sizeof(float4));
  EXPECT_EQ(decoded_image_memory(exr), sizeof(float4));
  EXPECT_THROW(decode_image(exr, "tex", 3), Error);
  EXPECT_THROW(decode_image(hdr, "tex", 0), Error);
}

TEST(ImageFile, WhatDecodingTakesBesideThePicture) {
  const Rgba8Image image(48, 32, {200, 100, 50, 255});
  EXPECT_EQ(image_working_memory(encode_png(image)), 0u);
  EXPECT_EQ(image_working_memory(encode_webp(image, false)), 48u * 32 * 5);
  EXPECT_EQ(image_working_memory(encode_jpeg(image)), 48u * 32 * 3 * 2);  // no chroma subsampling
  // 4:2:0 subsampling: half a chroma sample per pixel.
  const Bytes halves{0xff, 0xd8, 0xff, 0xc2, 0,    17, 8,  0, 32, 0, 48, 3, 1, 0x22, 0, 2, 0x11, 0,
                     3,    0x11, 0,    0xff, 0xda, 0,  12, 3, 1,  0, 2,  0, 3, 0,    0, 0, 0};
  EXPECT_EQ(image_working_memory(halves), 48u * 32 * 3);
  // The pixels of an EXR, and six times what the file packs together: here all of its single channel.
  const std::vector<float> values(64);
  const Bytes exr = encode_exr(8, 8, {{"Y", ExrType::Float, values.data(), nullptr, 1}});
  EXPECT_EQ(image_working_memory(exr), 64 * sizeof(Linear) + 6 * 64 * sizeof(float));
  EXPECT_EQ(image_working_memory(Bytes{1, 2, 3}), 0u);
}

TEST(ImageFile, SizeOfAJpegIsKnownWhereverItCanBeDecoded) {
  const Bytes whole = encode_jpeg(Rgba8Image(9, 7, {200, 100, 50, 255}));
  for (const Bytes& between : {Bytes{0}, Bytes{1, 2, 3}, Bytes{0xff, 0}, Bytes{0xff, 0xff}}) {
    Bytes bytes = whole;
    const std::size_t after_first = 4 + std::size_t{bytes[4]} * 256 + bytes[5];
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(after_first), between.begin(), between.end());
    EXPECT_EQ(decode_image(bytes, "tex", 100).texels, decode_image(whole, "tex", 100).texels);
    EXPECT_EQ(find_image_size(bytes), (int2{9, 7}));
  }
}

TEST(ImageFile, LightWithoutAlphaStaysAsItIs) {
  const float light[] = {3, 0};
  const Bytes exr =
      encode_exr(1, 1, {{"Y", ExrType::Float, light, nullptr, 1}, {"A", ExrType::Float, light + 1, nullptr, 1}});
  EXPECT_EQ(decode_image(exr, "tex", 4).texels, Plane<float4>(1, 1, float4{3, 3, 3, 0}));
}

TEST(ImageFile, PfmIsLight) {
  LinearImage image(2, 1, Linear{3, 0.5f, 0.25f, 1});
  image(1, 0) = {1e-3f, 7000, 2, 1};
  const Bytes bytes = encode_pfm(image);
  EXPECT_EQ(find_image_size(bytes), (int2{2, 1}));
  EXPECT_EQ(decoded_image_memory(bytes), 2 * sizeof(float4));
  Plane<float4> expected(2, 1, float4{3, 0.5f, 0.25f, 1});
  expected(1, 0) = {1e-3f, 7000, 2, 1};
  EXPECT_EQ(decode_image(bytes, "tex", 2).texels, expected);
  EXPECT_THROW(decode_image(bytes, "tex", 1), Error);
  EXPECT_THROW(decode_image(std::span(bytes).first(bytes.size() - 1), "tex", 2), Error);
}

TEST(ImageFile, WarnsOfWhatIsDrawnSmaller) {
  EXPECT_EQ(size_warning({"a", Rgba8Image(32768, 2)}), std::nullopt);
  EXPECT_EQ(size_warning({"a", Rgba8Image(2, 32769)}),
            "texture a: 2 x 32769 texels are drawn as 2 x 16384, at most 32768 a side");
}

TEST(ImageFile, OtherFormatsAreNamed) {
  const auto bytes = [](const std::string& text) { return Bytes(text.begin(), text.end()); };
  EXPECT_EQ(decode_error(bytes("RIFF....WEBPVP8 ")), "tex: not a sound WebP file");
  EXPECT_EQ(
      decode_error(bytes("\xabKTX 11\xbb\r\n\x1a\n")),
      "tex: is a KTX 1 image, expected PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, PFM, KTX2, BMP or TGA");
  EXPECT_EQ(decode_error(bytes("8BPS")),
            "tex: is a PSD image, expected PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, PFM, KTX2, BMP or TGA");
  EXPECT_EQ(
      decode_error({}),
      "tex: is no known image, expected PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, PFM, KTX2, BMP or TGA");
  EXPECT_NE(decode_error(bytes("\x89PNG\r\n\x1a\n")), "no error");
  EXPECT_NE(decode_error(bytes("\xff\xd8\xff")), "no error");
}

}  // namespace
}  // namespace zoneplate
