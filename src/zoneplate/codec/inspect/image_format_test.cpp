// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/image_format.h"

#include <gtest/gtest.h>

#include "zoneplate/codec/apng.h"
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
  EXPECT_EQ(format_of(std::string_view("II*\0abc", 7)), "a TIFF");
  EXPECT_EQ(format_of(std::string_view("\0\0\0\x1c"
                                       "ftypavif",
                                       12)),
            "an AVIF");
  EXPECT_EQ(format_of(std::string_view("\0\0\0\x1c"
                                       "ftypheic",
                                       12)),
            "a HEIC");
  EXPECT_EQ(format_of("hello"), "no known");
  EXPECT_EQ(format_of(""), "no known");
  EXPECT_STREQ(unread_format({}, "x", "PNG").what(), "x: is no known image, expected PNG");
}

TEST(ImageFormat, FramesOfAnAnimationAreCounted) {
  EXPECT_EQ(count_frames(encode_png(Rgba8Image(2, 2))), 1u);
  Animation animation;
  for (int i = 0; i < 3; ++i)
    animation.frames.push_back(Rgba8Image(2, 2, Rgba8{static_cast<std::uint8_t>(40 * i), 0, 0, 255}));
  const std::vector<std::uint8_t> file = encode_apng(animation);
  EXPECT_EQ(count_frames(file), 3u);
  EXPECT_EQ(count_frames(std::span(file).first(40)), 1u);
}

}  // namespace
}  // namespace zoneplate
