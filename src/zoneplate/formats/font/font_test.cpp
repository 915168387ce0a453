// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/font/font.h"
#include "zoneplate/base/paths_for_test.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"
#include "zoneplate/sdf/exact_coverage.h"

namespace zoneplate {
namespace {

// The letter I of DejaVu Sans is a rectangle from (201, 0) to (403, 1493) of 2048 units.
TEST(Font, ReadsOutlinesInEm) {
  const Font font(dejavu_path("DejaVuSans.ttf"));
  const sdf::Bounds bounds = font.outline(U'I').bounds();
  EXPECT_DOUBLE_EQ(bounds.low.x * 2048, 201);
  EXPECT_DOUBLE_EQ(bounds.low.y * 2048, -1493);
  EXPECT_DOUBLE_EQ(bounds.high.y, 0);
  EXPECT_TRUE(font.has(U'é'));
  EXPECT_FALSE(font.has(0x10ffff));
  EXPECT_TRUE(font.outline(U' ').contours.empty());
  EXPECT_GT(font.outline(0x10ffff).contours.size(), 0u);
  EXPECT_NEAR(text_width(font, "AV", 100), 100 * (font.advance(U'A') + font.advance(U'V') + font.kerning(U'A', U'V')),
              1e-9);
  EXPECT_LT(font.kerning(U'A', U'V'), 0);
}

TEST(Font, ALineHasTheAreaOfItsGlyphs) {
  const Font font(dejavu_path("DejaVuSans.ttf"));
  const sdf::Outline line = text_outline(font, "II", 64);
  const Plane<float> coverage = sdf::exact_coverage(line, {64, 64, {0, -56}, 1});
  double area = 0;
  for (const float c : coverage.values()) area += static_cast<double>(c);
  const sdf::Bounds one = font.outline(U'I').bounds();
  EXPECT_NEAR(area, 2 * 64 * 64 * (one.high.x - one.low.x) * (one.high.y - one.low.y), 1e-3);
}

TEST(Font, RefusesOtherFiles) {
  const auto message = [](const std::string& path) {
    try {
      Font font(path);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message("/none.ttf"), "/none.ttf: no such file");
  EXPECT_EQ(message(std::string(source_root) + "/README.md"), std::string(source_root) + "/README.md: not a font");
}

}  // namespace
}  // namespace zoneplate
