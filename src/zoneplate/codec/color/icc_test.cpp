// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/color/icc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/color/icc_for_test.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/os/library.h"

namespace zoneplate {
namespace {

class Icc : public testing::Test {
 protected:
  void SetUp() override {
    if (!open_library(Library::Lcms)) GTEST_SKIP() << "liblcms2-2 is not installed";
  }
  static std::string refusal(const IccBytes& profile, bool is_grey = false) {
    try {
      read_icc_space(profile, is_grey);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(Icc, DisplayP3IsWhatItsCodePointsSay) {
  const RgbSpace space = read_icc_space(icc_display_p3(), false);
  const RgbSpacePtr expected = make_rgb_space({.cicp = {{12, 13, 0, 1}}});
  EXPECT_EQ(space.name, "Display P3");
  ASSERT_EQ(space.curves.size(), 1u);  // one for red, green and blue
  for (std::size_t i = 0; i < curve_size; i += 97)
    EXPECT_NEAR(space.curves[0][i], decode_srgb(static_cast<float>(i) / 65535), 1e-5);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(space.rec709_from_rgb[i], expected->rec709_from_rgb[i], 1e-3);
}

TEST_F(Icc, AProfileOfSrgbIsStandard) {
  RgbSpace space = read_icc_space(icc_of_primaries(srgb_icc_primaries, icc_srgb_curve(), "sRGB"), false);
  recognize_standard(space);
  EXPECT_TRUE(space.is_standard);
  space = read_icc_space(icc_display_p3(), false);
  recognize_standard(space);
  EXPECT_FALSE(space.is_standard);
  space = read_icc_space(icc_of_primaries(srgb_icc_primaries, icc_power(1.8), "1.8"), false);
  recognize_standard(space);
  EXPECT_FALSE(space.is_standard);
}

TEST_F(Icc, TablesGiveLight) {
  RgbSpace space = read_icc_space(icc_of_table(), false);
  EXPECT_FALSE(space.grid.empty());
  EXPECT_FALSE(can_encode(space));
  // XYZ of D50 white, and of half of it, in codes.
  for (const float y : {1.0f, 0.5f, 0.1f}) {
    constexpr float scale = 1 + 32767.0f / 32768;
    const auto code = [&](float xyz) { return std::sqrt(xyz * y / scale); };
    DisplayImage codes(1, 1, {code(0.9642f), code(1), code(0.8249f), 1});
    const Linear light = light_of(codes, space)(0, 0);
    for (const float channel : {light.r, light.g, light.b}) EXPECT_NEAR(channel, y, 0.01f);
  }
}

TEST_F(Icc, GreyProfilesAreOfGreyPixels) {
  const IccBytes grey = icc_of({.pixels = "GRAY"}, {{"desc", icc_text("grey")}, {"kTRC", icc_power(1.8)}});
  const RgbSpace space = read_icc_space(grey, true);
  EXPECT_NEAR(space.curves.at(0)[32768], std::pow(0.5, 1.8), 1e-4);
  EXPECT_EQ(refusal(grey), "is of GRAY pixels, expected RGB");
}

TEST_F(Icc, RefusalsNameTheCause) {
  const IccBytes p3 = icc_display_p3();
  EXPECT_EQ(refusal({}), "has no header");
  EXPECT_EQ(refusal(IccBytes(500, 7)), "has no header");
  EXPECT_EQ(refusal({p3.begin(), p3.begin() + 200}),
            "is cut off: it states " + std::to_string(p3.size()) + " bytes and has 200");
  const auto of = [](const IccKind& kind) { return icc_of_primaries(p3_primaries, icc_srgb_curve(), "", kind); };
  EXPECT_EQ(refusal(of({.pixels = "CMYK"})), "is of CMYK pixels, expected RGB");
  EXPECT_EQ(refusal(of({.kind = "link"})), "is of class link, which describes no image");
  EXPECT_EQ(refusal(icc_of({}, {{"desc", icc_text("")}})), "has no sound curve of red");
  EXPECT_EQ(refusal(icc_of_primaries({}, icc_srgb_curve(), "")), "has primaries that span no triangle");
  IccBytes huge = p3;
  huge.resize(max_icc_bytes + 1);
  EXPECT_EQ(refusal(huge), "has 4194305 bytes, at most 4194304 are read");
}

TEST_F(Icc, DamageIsAnError) {
  std::mt19937 random(1);
  for (const IccBytes& sound : {icc_display_p3(), icc_of_table()})
    for (int i = 0; i < 15; ++i) {
      IccBytes damaged = sound;
      for (int k = 0; k < 1 + i % 5; ++k) damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
      const std::string message = refusal(damaged);
      EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

}  // namespace
}  // namespace zoneplate
