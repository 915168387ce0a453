// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/os/run_program.h"

namespace zoneplate {
namespace {

bool has_gnuplot() {
  try {
    return run_child("gnuplot", {"--version"}, "").code == 0;
  } catch (const Error&) {
    return false;
  }
}

Plot line_plot() {
  return {.title = "a title", .x = {"x (pixels)", 0, 4}, .y = {"y", 0, 2}, .curves = {{"level", {{0, 1}, {4, 1}}}}};
}

int count(const Rgba8Image& image, Rgba8 color) {
  return static_cast<int>(std::count(image.values().begin(), image.values().end(), color));
}
bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(Plot, ALevelLineHasItsColourLengthAndPlace) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  Plot plot = line_plot();
  plot.curves[0].name.clear();
  const Rgba8Image image = plot_picture(plot, {400, 300});
  ASSERT_EQ(image.width(), 400);
  ASSERT_EQ(image.height(), 300);
  EXPECT_EQ(image(0, 0), (Rgba8{255, 255, 255, 255}));
  // The line crosses the whole plot in one or two full rows near its middle.
  int rows = 0, longest = 0, place = 0;
  for (int y = 0; y < 300; ++y) {
    const auto row = image.row(y);
    const int n = static_cast<int>(std::count(row.begin(), row.end(), plot_palette()[0]));
    if (n > 200) ++rows, place = y;
    longest = std::max(longest, n);
  }
  EXPECT_GE(rows, 1);
  EXPECT_LE(rows, 3);
  EXPECT_GT(longest, 280);
  EXPECT_NEAR(place, 135, 15);
}

TEST(Plot, TheSameBytesEveryTimeAndNoDate) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::string svg = plot_svg(line_plot());
  EXPECT_EQ(svg, plot_svg(line_plot()));
  EXPECT_EQ(plot_picture(line_plot()), plot_picture(line_plot()));
  EXPECT_TRUE(contains(svg, "<svg")) << svg.substr(0, 300);
  EXPECT_TRUE(contains(svg, "a title"));
  EXPECT_TRUE(contains(svg, "x (pixels)"));
  EXPECT_TRUE(contains(svg, "level"));
  EXPECT_FALSE(contains(svg,
                        "20"
                        "26-"));
}

TEST(Plot, TextsAreTextsWhateverTheyHold) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  Plot plot = line_plot();
  plot.title = "it's `date` @x \\n \"q\" {a}_b^c\nEOD";
  plot.curves[0].name = "'; set output '/tmp/harm";
  const std::string svg = plot_svg(plot);
  EXPECT_TRUE(contains(svg, "it’s `date` @x \\n &quot;q&quot; {a}_b^c EOD") ||
              contains(svg, "it’s `date` @x \\n \"q\" {a}_b^c EOD"))
      << svg;
  EXPECT_TRUE(contains(svg, "set output")) << svg;
}

TEST(Plot, EveryMarkLeavesItsColour) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  using Mark = Curve::Mark;
  for (const Mark mark :
       {Mark::Line, Mark::Dashed, Mark::Points, Mark::LineAndPoints, Mark::Stems, Mark::Steps, Mark::Area}) {
    const Plot plot = {.title = "", .x = {"x"}, .y = {"y"}, .curves = {{"", {{0, 0.5}, {1, 2}, {2, 1}}, mark, 2}}};
    EXPECT_GT(count(plot_picture(plot, {300, 200}), plot_palette()[2]), 20) << static_cast<int>(mark);
  }
}

TEST(Plot, PointsMayHaveNames) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  Plot plot = line_plot();
  plot.curves[0].mark = Curve::Mark::Points;
  plot.curves[0].labels = {"msaa:n=4", "a \"quoted\\name"};
  const std::string svg = plot_svg(plot);
  EXPECT_TRUE(contains(svg, "msaa:n=4"));
  EXPECT_TRUE(contains(svg, "a  quoted name"));
}

TEST(Plot, LogarithmsOfFewDecadesHaveTicksBetweenThem) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  Plot plot = line_plot();
  plot.x = {.label = "x", .low = 3, .high = 400, .is_logarithmic = true};
  const std::string few = plot_svg(plot);
  for (const char* tick : {">5<", ">10<", ">20<", ">50<", ">200<"}) EXPECT_TRUE(contains(few, tick)) << tick;
  EXPECT_FALSE(contains(few, ">500<"));
  plot.x.high = 40000;
  const std::string many = plot_svg(plot);
  EXPECT_FALSE(contains(many, ">20<"));
  EXPECT_TRUE(contains(many, ">1000<"));
}

TEST(Plot, PointsThatAreNotFiniteInterruptTheLine) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const auto pixels = [](double middle) {
    const Plot plot = {.title = "",
                       .x = {"x", 0, 4},
                       .y = {"y", 0, 2},
                       .curves = {{"", {{0, 1}, {1, 1}, {2, middle}, {3, 1}, {4, 1}}}}};
    return count(plot_picture(plot, {400, 300}), plot_palette()[0]);
  };
  EXPECT_NEAR(pixels(NAN), pixels(1) / 2, pixels(1) / 20);
}

TEST(Plot, SeveralStandInRowsAndColumns) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::vector<Plot> plots(3, line_plot());
  const Rgba8Image image = plots_picture(plots, 2, {300, 200});
  EXPECT_EQ(image.width(), 600);
  EXPECT_EQ(image.height(), 400);
  const auto part = [&](int left, int top) {
    int n = 0;
    for (int y = top; y < top + 200; ++y)
      for (int x = left; x < left + 300; ++x) n += image(x, y) == plot_palette()[0];
    return n;
  };
  EXPECT_GT(part(0, 0), 150);
  EXPECT_GT(part(300, 0), 150);
  EXPECT_GT(part(0, 200), 150);
  EXPECT_EQ(part(300, 200), 0);
}

TEST(Plot, NothingToDrawIsAnEmptyPlot) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  EXPECT_EQ(plot_picture({.title = "none", .x = {"x", 0, 1}, .y = {"y", 0, 1}, .curves = {}}).width(), 720);
}

}  // namespace
}  // namespace zoneplate
