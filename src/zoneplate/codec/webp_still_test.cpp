// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/webp_still.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "zoneplate/base/error.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

// Noise with alpha values of all kinds, so that no colour can be predicted from another.
Rgba8Image make_image() {
  Rgba8Image image(37, 23);
  for (std::uint32_t i = 0; i < image.values().size(); ++i) {
    const std::uint32_t word = hash(i);
    const auto byte = [&](int shift) { return static_cast<std::uint8_t>(word >> shift); };
    image.values()[i] = {byte(0), byte(8), byte(16), static_cast<std::uint8_t>(i % 4 == 0 ? 0 : byte(24))};
  }
  return image;
}

TEST(WebpStill, ColoursThatAlphaHidesAreKept) {
  const Rgba8Image image = make_image();
  const auto file = encode_webp(image, true);
  EXPECT_EQ(decode_webp(file, "a", 1000), image);
  EXPECT_EQ(find_webp_size(file), (int2{37, 23}));
  EXPECT_EQ(encode_webp(image, true), file);
}

TEST(WebpStill, WithoutAlphaEveryPixelIsOpaque) {
  Rgba8Image image = make_image();
  const auto file = encode_webp(image, false);
  for (Rgba8& c : image.values()) c.a = 255;
  EXPECT_EQ(decode_webp(file, "a", 1000), image);
}

TEST(WebpStill, RefusesWhatTheFormatCannotHold) {
  EXPECT_THROW(encode_webp(Rgba8Image(16384, 1), false), Error);
  EXPECT_THROW(decode_webp(encode_webp(make_image(), true), "a", 850), Error);
}

TEST(WebpStill, AClaimOfManyPixelsTakesNoMemory) {
  // A lossless image of 16384 x 16384 pixels without pixel data.
  std::vector<std::uint8_t> bytes = {'R',  'I', 'F', 'F', 26, 0, 0,    0,    'W',  'E',  'B',  'P',
                                     'V',  'P', '8', 'L', 13, 0, 0,    0,    0x2f, 0xff, 0xff, 0xff,
                                     0x0f, 0,   0,   0,   0,  0, 0xff, 0xff, 0xff, 0xff};
  ASSERT_EQ(find_webp_size(bytes), (int2{16384, 16384}));
  const auto max_memory = [] {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;  // KiB
  };
  const long before = max_memory();
  EXPECT_THROW(decode_webp(bytes, "a", 1 << 28), Error);
  EXPECT_LT(max_memory() - before, 200 << 10);
}

}  // namespace
}  // namespace zoneplate
