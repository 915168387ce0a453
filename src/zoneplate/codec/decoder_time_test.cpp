// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/jpeg.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp_still.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// The error message of a decoder that starts after its deadline.
std::string late(const std::function<void()>& decode) {
  try {
    with_deadline(0, ErrorKind::Failed, "the time is up", decode);
  } catch (const Error& error) {
    return error.what();
  }
  return "decoded";
}

constexpr std::uint64_t many = 1 << 20;

TEST(DecoderTime, IsCheckedByEveryDecoder) {
  const Rgba8Image image(40, 30, {10, 20, 30, 255});
  const std::string up = "the time is up";
  const Bytes png = encode_png(image), jpeg = encode_jpeg(image), webp = encode_webp(image, true);
  EXPECT_EQ(late([&] { decode_png_as_stored(png, "image", many); }), up);
  EXPECT_EQ(late([&] { decode_png(png, "image", many); }), up);
  EXPECT_EQ(late([&] { decode_jpeg(jpeg, "image", many); }), up);
  EXPECT_EQ(late([&] { decode_webp(webp, "image", many); }), up);
  const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x01\x02\x03\x04";
  const Bytes light(hdr.begin(), hdr.end());
  EXPECT_EQ(late([&] { decode_hdr(light, "image", many); }), up);
  const std::vector<float> values(12, 0.5f);
  const Bytes exr = encode_exr(4, 3, {{"R", ExrType::Half, values.data()}}, {});
  EXPECT_EQ(late([&] { decode_exr(exr, "image", many); }), up);
}

}  // namespace
}  // namespace zoneplate
