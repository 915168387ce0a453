// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/image_format.h"

#include <gtest/gtest.h>

#include "zoneplate/codec/png.h"

namespace zoneplate {
namespace {

std::string_view format_of(std::string_view text) {
  return format_of_image({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(ImageFormat, IsNamedByTheFirstBytes) {
  EXPECT_EQ(format_of_image(encode_png(Rgba8Image(1, 1))), "a PNG");
  EXPECT_EQ(format_of("GIF89a"), "a GIF");
  EXPECT_EQ(format_of("BM6"), "a BMP");
  EXPECT_EQ(format_of(std::string_view("II*\0abcd", 8)), "a TIFF");
  EXPECT_EQ(format_of(std::string_view("\0\0\0\x1c"
                                       "ftypavif",
                                       12)),
            "an AVIF");
  EXPECT_EQ(format_of(std::string_view("\0\0\0\x1c"
                                       "ftypheic",
                                       12)),
            "a HEIC");
  EXPECT_EQ(format_of(std::string_view("\0\0\0\x1c"
                                       "ftypisom",
                                       12)),
            "an MP4 video");
  EXPECT_EQ(format_of("hello"), "no known");
  EXPECT_EQ(format_of(""), "no known");
  EXPECT_STREQ(unread_format({}, "x", "PNG").what(), "x: is no known image, expected PNG");
  const std::vector<std::uint8_t> matroska = {0x1a, 0x45, 0xdf, 0xa3};
  EXPECT_STREQ(unread_format(matroska, "x", "PNG").what(), "x: is a Matroska video, expected PNG");
}

}  // namespace
}  // namespace zoneplate
