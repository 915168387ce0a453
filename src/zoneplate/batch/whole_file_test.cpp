// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/whole_file.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp_still.h"

namespace zoneplate {
namespace {

std::vector<std::pair<std::string, std::vector<std::uint8_t>>> files() {
  Rgba8Image image(13, 37);
  LinearImage linear(13, 37);
  Plane<float> grey(13, 37);
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    const auto code = static_cast<std::uint8_t>(i * i);
    image.values()[i] = {code, static_cast<std::uint8_t>(i), 3, 255};
    linear.values()[i] = {static_cast<float>(code), 2, 3, 1};
  }
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> out = {{".png", encode_png(image, {})},
                                                                        {".jpg", encode_jpeg(image)},
                                                                        {".webp", encode_webp(image, false)},
                                                                        {".pfm", encode_pfm(linear)},
                                                                        {".pfm", encode_pfm(grey)}};
  for (const ExrCompression kind : {ExrCompression::None, ExrCompression::Zips, ExrCompression::Zip})
    out.emplace_back(".exr", encode_exr(13, 37, rgba_channels(linear), {}, kind));
  const std::string mp4(
      "\0\0\0\x0c"
      "ftypmp42"
      "\0\0\0\x0b"
      "mdatabc"
      "\0\0\0\1"
      "moov"
      "\0\0\0\0\0\0\0\x11"
      "z",
      40);
  out.emplace_back(".mp4", std::vector<std::uint8_t>(mp4.begin(), mp4.end()));
  return out;
}

TEST(WholeFile, OurFilesAreWholeAndTheirBeginningsAreNot) {
  for (const auto& [extension, bytes] : files()) {
    EXPECT_TRUE(is_whole_file(extension, bytes)) << extension;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const bool is_box = extension == ".mp4" && (size == 12 || size == 23);  // each box is a whole file
      EXPECT_EQ(is_whole_file(extension, std::span(bytes).first(size)), is_box) << extension << ' ' << size;
    }
    std::vector<std::uint8_t> zeros(bytes.size());
    EXPECT_FALSE(is_whole_file(extension, zeros)) << extension;
  }
}

TEST(WholeFile, OthersHaveContents) {
  for (const char* extension : {".rgba", ".mkv", ".webm"}) {
    EXPECT_FALSE(is_whole_file(extension, {}));
    const std::vector<std::uint8_t> some(5);
    EXPECT_TRUE(is_whole_file(extension, some));
  }
}

}  // namespace
}  // namespace zoneplate
