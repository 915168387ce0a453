// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/sdf/sdf.h"

#include "zoneplate/cli/signal/signal_for_test.h"

namespace zoneplate::cli {
namespace {

class SdfVerb : public SignalVerb {};

TEST_F(SdfVerb, DrawsAScene) {
  save("s.sdf", "canvas 40 30 background #000000\nfill #ffffff circle(20, 15, 10)\n");
  const auto report = json(run_sdf_draw, {at("s.sdf"), "-o", at("s.png"), "--error"});
  EXPECT_EQ(report["layers"], 1);
  EXPECT_LT(report["error"]["greatest"], 0.0118);
  EXPECT_GT(report["error"]["greatest"], 0.001);
  const Rgba8Image image = picture("s.png");
  EXPECT_EQ(image.width(), 40);
  EXPECT_EQ(image(20, 15), (Rgba8{255, 255, 255, 255}));
  EXPECT_EQ(image(2, 2), (Rgba8{0, 0, 0, 255}));
  json(run_sdf_draw, {at("s.sdf"), "-o", at("l.png"), "--size", "90x60"});
  EXPECT_EQ(picture("l.png")(45, 30), (Rgba8{255, 255, 255, 255}));
  EXPECT_EQ(picture("l.png")(45, 8), (Rgba8{0, 0, 0, 255}));  // 15 units are 30 pixels, the circle's radius is 20
}

TEST_F(SdfVerb, StoresAndShowsAField) {
  save("s.sdf", "canvas 40 30\nfill #ffffff circle(20, 15, 10)\n");
  const auto report = json(run_sdf_field, {at("s.sdf"), "-o", at("f.pfm"), "--scale", "2"});
  EXPECT_EQ(report["width"], 80);
  EXPECT_NEAR(static_cast<double>(report["least"]), -9.646,
              0.001);  // the nearest centre is 1/4 unit away along x and y
  for (const char* view : {"field", "isolines", "gradient"}) {
    out(run_sdf_field, {at("s.sdf"), "-o", at(std::string(view) + ".png"), "--show", view});
    EXPECT_NE(picture(std::string(view) + ".png")(20, 15), picture(std::string(view) + ".png")(1, 1)) << view;
  }
}

TEST_F(SdfVerb, RefusesWhatItCannotDraw) {
  save("empty.sdf", "background #000000");
  EXPECT_TRUE(contains(refusal(run_sdf_draw, {at("empty.sdf")}, ErrorKind::Input), "no canvas, and no shape"));
  save("wrong.sdf", "canvas 9 9\nfill #fff circel(1, 2, 3)");
  EXPECT_TRUE(contains(refusal(run_sdf_draw, {at("wrong.sdf")}, ErrorKind::Input),
                       "wrong.sdf: line 2, column 11: 'circel' is not a shape; did you mean circle?"));
  save("none.sdf", "canvas 9 9");
  EXPECT_TRUE(contains(refusal(run_sdf_field, {at("none.sdf")}, ErrorKind::Input), "no layer"));
  save("large.sdf", "canvas 30000 30000");
  EXPECT_TRUE(contains(refusal(run_sdf_draw, {at("large.sdf")}), "30000 × 30000 pixels is too large"));
}

TEST_F(SdfVerb, HelpListsEveryShape) {
  const std::string help = out(run_sdf_draw, {"--help"});
  for (const char* word : {"smooth-difference(width, shapes)", "regular-polygon(x, y, radius, corners)", "path(text)"})
    EXPECT_TRUE(contains(help, word)) << word;
}

}  // namespace
}  // namespace zoneplate::cli
