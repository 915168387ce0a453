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

TEST_F(SdfVerb, AMaskIsTheSignOfItsField) {
  save("s.sdf", "canvas 40 30 background #000000\nfill #ffffff turn(20, rectangle(22, 6, 20, 10))\n");
  out(run_sdf_draw, {at("s.sdf"), "-o", at("s.png")});
  const auto report = json(run_sdf_from_mask, {at("s.png"), "-o", at("f.exr")});
  EXPECT_GT(report["inside"], 150);
  out(run_sdf_to_mask, {at("f.exr"), "-o", at("m.png")});
  const Rgba8Image image = picture("s.png"), mask = picture("m.png");
  for (std::size_t i = 0; i < image.values().size(); ++i)
    EXPECT_EQ(mask.values()[i].r > 188, image.values()[i].r >= 128) << i;  // 188 is half of the light, 128 of the codes
  EXPECT_EQ(json(run_sdf_to_mask, {at("f.exr"), "-o", at("l.png"), "--scale", "3"})["width"], 120);
  EXPECT_TRUE(
      contains(refusal(run_sdf_from_mask, {at("s.png"), "--threshold", "1"}, ErrorKind::Input), "no pixel is inside"));
  EXPECT_TRUE(contains(refusal(run_sdf_to_mask, {at("s.png")}), "expected a field of distances"));
}

TEST_F(SdfVerb, TextFromAnAtlasFileIsThatFromMemory) {
  const Words atlas = {"--characters", "Zone k", "-o", at("a.png"), "--metrics", at("a.json")};
  EXPECT_EQ(json(run_sdf_atlas, atlas)["glyphs"], 6);
  const nlohmann::json metrics = parsed_json(text("a.json"));
  EXPECT_EQ(metrics["atlas"]["type"], "msdf");
  EXPECT_EQ(metrics["glyphs"][0]["unicode"], 32);
  EXPECT_FALSE(metrics["glyphs"][0].contains("planeBounds"));
  out(run_sdf_text, {"Zone k", "-o", at("memory.png"), "--size", "90"});
  const auto report = json(run_sdf_text, {"Zone k", "-o", at("file.png"), "--size", "90", "--atlas", at("a.png"),
                                          "--metrics", at("a.json")});
  EXPECT_EQ(picture("memory.png"), picture("file.png"));
  EXPECT_LT(report["rms"], 0.06);
  const std::string table = out(run_sdf_text, {"Zone", "--sizes", "16,64"});
  EXPECT_TRUE(contains(table, "msdf rms")) << table;
  save("b.json", R"({"atlas": {"type": "softmask", "size": 32}})");
  EXPECT_TRUE(
      contains(refusal(run_sdf_text, {"Z", "--atlas", at("a.png"), "--metrics", at("b.json")}, ErrorKind::Input),
               "type is 'softmask', expected sdf, psdf, msdf or mtsdf"));
  EXPECT_TRUE(contains(refusal(run_sdf_text, {"Z", "--atlas", at("a.png")}), "belong together"));
}

TEST_F(SdfVerb, ScenesHaveText) {
  save("t.sdf", "canvas 60 40 background #ffffff\nfill #000000 text(10, 30, 30, \"I\")");
  out(run_sdf_draw, {at("t.sdf"), "-o", at("t.png")});
  EXPECT_EQ(picture("t.png")(14, 20), (Rgba8{0, 0, 0, 255}));  // the stem is from 2.9 to 5.9 pixels from the pen
  EXPECT_EQ(picture("t.png")(20, 20), (Rgba8{255, 255, 255, 255}));
}

TEST_F(SdfVerb, HelpListsEveryShape) {
  const std::string help = out(run_sdf_draw, {"--help"});
  for (const char* word : {"smooth-difference(width, shapes)", "regular-polygon(x, y, radius, corners)", "path(text)"})
    EXPECT_TRUE(contains(help, word)) << word;
}

}  // namespace
}  // namespace zoneplate::cli
