// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/language/scene_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/math/random.h"
#include "zoneplate/sdf/evaluate.h"

namespace zoneplate::sdf {
namespace {

std::string message_of(const std::string& text) {
  try {
    read_scene_file(text, "s");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "no error";
}

constexpr const char* text_scene = R"(// every kind of statement
canvas 64 48 background #204060
let eye = circle(20, 24, 12)  let box = turn(30, rectangle(30, 0, 20, 10))
fill #ff8000cc smooth-union(6, eye, box, polygon(40, 4, 60, 4, 50, 20))
stroke #fff 2.5 union(path("M 5 5 h 10 v 10 z"), grid(2, 3, 9, 9, diamond(0, 0, 4)))
)";

constexpr const char* json_scene = R"({
  "canvas": [64, 48], "background": "#204060",
  "let": {"eye": {"circle": [20, 24, 12]}, "box": {"turn": [30, {"rectangle": [30, 0, 20, 10]}]}},
  "layers": [
    {"fill": "#ff8000cc", "shape": {"smooth-union": [6, {"eye": []}, {"box": []}, {"polygon": [40, 4, 60, 4, 50, 20]}]}},
    {"shape": {"union": [{"path": ["M 5 5 h 10 v 10 z"]}, {"grid": [2, 3, 9, 9, {"diamond": [0, 0, 4]}]}]},
     "stroke": "\u0023fff", "width": 2.5}]})";

TEST(SdfSceneFile, BothLanguagesGiveTheSameImage) {
  const SceneFile a = read_scene_file(text_scene, "a"), b = read_scene_file(json_scene, "b");
  EXPECT_EQ(a.width, 64);
  EXPECT_EQ(a.height, 48);
  EXPECT_EQ(a.drawing.layers.size(), 2u);
  const Raster raster{64, 48, {}, 1};
  const LinearImage image = draw(a.drawing, raster, a.background);
  EXPECT_EQ(image, draw(b.drawing, raster, b.background));
  EXPECT_EQ(image(63, 47), a.background);
  EXPECT_NE(image(20, 24), a.background);
}

// The library's shapes are measured by brute force in shape_test.cpp.
TEST(SdfSceneFile, WordsGiveTheDistancesOfTheirShapes) {
  std::vector<Point> points;
  for (std::uint32_t i = 0; i < 100'000; ++i)
    points.push_back(
        {static_cast<double>(20 * unit_float(hash(i, 1))), static_cast<double>(20 * unit_float(hash(i, 2)))});
  const auto distances = [&](const std::string& shape) {
    return distances_at(read_scene_file("fill #000 " + shape, "s", {.keeps_shapes = true}).shapes.at(0), points);
  };
  EXPECT_EQ(distances("square(9, 10, 6)"), distances_at(moved({9, 10}, rectangle(6, 6)), points));
  EXPECT_EQ(distances("diamond(9, 10, 6)"), distances_at(moved({9, 10}, rhombus(6, 6)), points));
  EXPECT_EQ(distances("path(\"M 3 4 h 10 l 2 8 z\")"), distances("polygon(3, 4, 13, 4, 15, 12)"));
  const std::vector<float> found = distances("line(4, 5, 15, 12, 3)");
  const Point a{4, 5}, along = Point{15, 12} - a;
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double t = std::clamp(dot(points[i] - a, along) / dot(along, along), 0.0, 1.0);
    worst = std::max(worst, std::abs(length(points[i] - (a + along * t)) - 1.5 - static_cast<double>(found[i])));
  }
  EXPECT_LT(worst, 1e-5);
}

TEST(SdfSceneFile, EveryTextErrorNamesLineAndColumn) {
  const std::pair<const char*, const char*> cases[] = {
      {"circle(1,2,3)",
       "line 1, column 1: 'circle' is not a statement; expected canvas, background, let, fill or stroke"},
      {"fill red circle(1,2,3)", "line 1, column 6: expected a colour as #rrggbb, found 'r'"},
      {"fill #12 circle(1,2,3)", "line 1, column 6: '#12' is not a colour; expected #rgb, #rgba, #rrggbb or #rrggbbaa"},
      {"\nfill #fff cirle(1,2,3)", "line 2, column 11: 'cirle' is not a shape; did you mean circle?"},
      {"fill #fff circle(1,2)", "line 1, column 11: circle(x, y, radius) has 2 arguments"},
      {"fill #fff circle(1,2,3,4)", "line 1, column 11: circle(x, y, radius) has 4 arguments"},
      {"fill #fff circle(1,2,-3)", "line 1, column 22: radius is -3; expected at least 0.0001"},
      {"fill #fff circle(1,2,\"r\")", "line 1, column 22: expected radius, a number, found a string"},
      {"fill #fff circle(1 2)", "line 1, column 20: expected ',' or ')', found '2'"},
      {"fill #fff circle(1,", "line 1, column 20: expected a number, found the end of the file"},
      {"fill #fff circle(1e999,2,3)", "line 1, column 18: the number is out of range"},
      {"fill #fff circle(2e6,2,3)", "line 1, column 18: x is 2e+06; the greatest number is 1e+06"},
      {"fill #fff regular-polygon(0,0,1,2.5)",
       "line 1, column 33: corners is 2.5; expected a whole number from 3 to 10000"},
      {"fill #fff polygon(1,2,3,4,5)", "line 1, column 11: polygon has x and y of 3 or more points; found 5 numbers"},
      {"fill #fff union()", "line 1, column 11: union has no shape"},
      {"fill #fff union(1)", "line 1, column 17: expected a shape, found a number"},
      {"fill #fff path(\"M 0 0\n L x\")", "line 1, column 16: path: character 10: expected a number, found 'x'"},
      {"fill #fff path(\"M 0", "line 1, column 16: the string has no closing quotation mark"},
      {"fill #fff text(0, 0, 9, \"a\")", "line 1, column 25: text: text requires a font, which is not available here"},
      {"let é = circle(1,2,3)", "line 1, column 5: expected a name, found byte 0xc3"},
      {"// é\nlet a = circle(1,2,3) // é\n  let a = circle(1,2,3)", "line 3, column 7: 'a' is defined twice"},
      {"let circle = circle(1,2,3)", "line 1, column 5: 'circle' is already a shape or an operation"},
      {"canvas 0 5", "line 1, column 8: expected a side of the canvas, a whole number of pixels from 1 to 32768"},
      {"stroke #000 0 circle(1,2,3)", "line 1, column 13: width is 0; expected at least 0.0001"},
      {"fill #fff scale(1e6, move(9, 9, circle(0, 0, 1)))",
       "line 1, column 1: a shape extends beyond a coordinate of 1e+06"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(message_of(text), std::string("s: ") + message);
  EXPECT_EQ(message_of("{\"a\\nb" + std::string(999, 'x') + "\": 1}"),
            "s: line 1, column 2: 'a?b" + std::string(296, 'x') + "...");
  std::string deep = "fill #fff ";
  for (int i = 0; i < 100; ++i) deep += "complement(";
  EXPECT_EQ(message_of(deep), "s: line 1, column 539: shapes are nested more than 48 deep");
  std::string many = "let a0 = repeat(9, 9, circle(0, 0, 1))\n";
  for (int i = 1; i <= 20; ++i)
    many += "let a" + std::to_string(i) + " = repeat(9, 9, a" + std::to_string(i - 1) + ")\n";
  EXPECT_EQ(message_of(many), "s: line 10, column 23: repeat: the shape has more than 1048576 instructions");
  // Names make shapes deeper than a line can.
  std::string chain = "let a0 = circle(0, 0, 1)\n";
  for (int i = 1; i <= 100'000; ++i) chain += fmt::format("let a{} = round(0, a{})\n", i, i - 1);
  EXPECT_EQ(message_of(chain), "s: line 65, column 20: round: operations are nested more than 64 deep");
  std::string moved = "let a0 = circle(0, 0, 1)\n";  // at 2^30 places
  for (int i = 1; i <= 30; ++i)
    moved += fmt::format("let a{0} = union(a{1}, move({2:.4f}, 0, a{1}))\n", i, i - 1, 0.0001 * (1 << i));
  EXPECT_EQ(message_of(moved + "fill #fff a30"), "s: line 32, column 1: the shape has more than 1048576 instructions");
}

TEST(SdfSceneFile, EveryJsonErrorNamesLineAndColumn) {
  const std::pair<const char*, const char*> cases[] = {
      {"{", "line 1, column 2: expected a string, found the end of the file"},
      {"{} x", "line 1, column 4: expected the end of the file, found 'x'"},
      {R"({"layer": []})",
       "line 1, column 2: 'layer' is not a member of a scene; expected canvas, background, let or layers"},
      {R"({"layers": [{}]})", "line 1, column 13: the layer has neither fill nor stroke"},
      {R"({"layers": [{"fill": "#fff"}]})", "line 1, column 13: the layer has no shape"},
      {"{\"layers\":\n[{\"fill\": \"#fff\", \"shape\": {}}]}",
       "line 2, column 28: a shape has one member, its name with its arguments; found none"},
      {R"({"layers": [{"fill": "#fff", "shape": {"circle": [1, 2]}}]})",
       "line 1, column 40: circle(x, y, radius) has 2 arguments"},
      {R"({"layers": [{"fill": "#fff", "shape": {"circle": [1, 2, nan]}}]})",
       "line 1, column 57: expected a number, found 'n'"},
      {R"({"layers": [{"fill": "#fff", "shape": {"circle": [1, 2, 3]}, "width": 2}]})",
       "line 1, column 13: a fill has no width"},
      {R"({"layers": [{"stroke": "#fff", "shape": {"circle": [1, 2, 3]}}]})",
       "line 1, column 13: the stroke has no width"},
      {R"({"layers": [{"fill": "#fff", "fill": "#fff"}]})", "line 1, column 30: a second 'fill' of a layer"},
      {R"({"background": "\ud800"})", "line 1, column 17: a surrogate without its other half"},
      {R"({"background": "\x"})", "line 1, column 18: expected an escape such as \\n, found 'x'"},
      {R"({"canvas": [640]})", "line 1, column 2: canvas has 2 numbers, width and height; found 1"},
      {R"({"canvas" [640]})", "line 1, column 11: expected ':' of member canvas, found '['"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(message_of(text), std::string("s: ") + message);
}

TEST(SdfSceneFile, ColoursArePremultipliedLight) {
  const auto background = [](const std::string& color) {
    return read_scene_file("background " + color, "s").background;
  };
  EXPECT_EQ(background("#fff"), (Linear{1, 1, 1, 1}));
  EXPECT_EQ(background("#f000"), (Linear{0, 0, 0, 0}));
  EXPECT_EQ(background("#FF000033"), (Linear{0.2f, 0, 0, 0.2f}));
}

TEST(SdfSceneFile, AllWordsAreListed) {
  EXPECT_EQ(shape_words().front().name, "circle");
  EXPECT_EQ(shape_words().back().name, "grid");
}

}  // namespace
}  // namespace zoneplate::sdf
