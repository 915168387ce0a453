// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/nis/nis.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/base/error.h"
#include "zoneplate/upscale/nis/taps.h"

namespace zoneplate::upscale {
namespace {

DisplayImage nis_chart() {
  const Rgba8Image codes = antialias::chart64();
  DisplayImage out(64, 64);
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    const Rgba8 c = codes.values()[i];
    out.values()[i] = {static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255, static_cast<float>(c.b) / 255, 1};
  }
  return out;
}

// Figures of NVIDIA's own shader, compiled as C++, which samples texels exactly at their centres.
TEST(Nis, AgreesWithFiguresOfTheShader) {
  struct Figures {
    int width, height;
    float sharpness;
    double sum, square, at_48_20;
  };
  for (const Figures& f : {Figures{96, 96, 0.5f, 15524.511420, 11400.546514, 0.832566},
                           Figures{128, 128, 1, 27580.076876, 20270.247593, 0.117647},
                           Figures{83, 71, 0, 9932.899406, 7292.022971, 0.941175},
                           Figures{64, 64, 0.5f, 6906.062178, 5095.795537, 0.862745}}) {
    const DisplayImage image = upscale_nis(nis_chart(), {64, 64, 0, 0, {f.width, f.height, std::nullopt}}, f.sharpness);
    double sum = 0, square = 0;
    for (const Display& c : image.values())
      for (const float v : {c.r, c.g, c.b}) sum += double{v}, square += double{v} * double{v};
    EXPECT_NEAR(sum, f.sum, 2e-3) << f.width;
    EXPECT_NEAR(square, f.square, 2e-3) << f.width;
    EXPECT_NEAR(image(48, 20).r, f.at_48_20, 1e-5) << f.width;
  }
}

TEST(Nis, TapsAreThosePublished) {
  const NisTaps taps = nis_taps();
  for (int phase = 0; phase < nis_phases; ++phase) {
    double scale = 0, sharpening = 0;
    for (int t = 0; t < 6; ++t)
      scale += double{taps.scale[8 * phase + t]}, sharpening += double{taps.sharpening[8 * phase + t]};
    EXPECT_NEAR(scale, 1, 1.001e-4) << phase;
    EXPECT_NEAR(sharpening, 0, 6.001e-4) << phase;
  }
  EXPECT_EQ(taps.scale[8 * 32 + 2], taps.scale[8 * 32 + 3]);
  EXPECT_EQ(taps.scale[2], 1);
}

TEST(Nis, MoreThanTwiceTheSizeIsRefused) {
  EXPECT_THROW(upscale_nis(nis_chart(), {64, 64, 0, 0, {130, 64, std::nullopt}}, 0.5f), Error);
}

}  // namespace
}  // namespace zoneplate::upscale
