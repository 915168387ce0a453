// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/language/svg_path.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"

namespace zoneplate::sdf {
namespace {

std::vector<Point> ends_of(const Outline& outline) {
  std::vector<Point> ends;
  for (const Contour& contour : outline.contours)
    for (const Segment& s : contour) ends.push_back(s.last());
  return ends;
}

TEST(SvgPath, ReadsLinesAbsoluteAndRelative) {
  const std::vector<Point> square = {{11, 2}, {11, 12}, {1, 12}, {1, 2}};
  for (const char* data : {"M1 2L11 2 11 12 1 12Z", "m1,2 10,0 0,10 -10 0z", "M1 2H11V12H1z", "m 1 2 h10 v10h-10 z",
                           "M1,2L+11,2L1.1e1,12L1,12", " M 1 2 l10-0 0 10-10.0.0Z"})
    EXPECT_EQ(ends_of(parse_svg_path(data)), square) << data;
  // After a closed subpath, the next one starts where it did.
  EXPECT_EQ(ends_of(parse_svg_path("M1 2h10v10h-10zl10 0 0 10")).size(), 7u);
}

TEST(SvgPath, ReadsCurvesWithReflectedControlPoints) {
  const Outline outline = parse_svg_path("M0 0C1 2 3 4 5 6S7 8 9 10Q1 1 2 2T3 3t1 1");
  const Contour& c = outline.contours.at(0);
  ASSERT_EQ(c.size(), 6u);  // and a line back
  EXPECT_EQ(c[1].p[1], (Point{7, 8}));
  EXPECT_EQ(c[2].degree, 2);
  EXPECT_EQ(c[3].p[1], (Point{3, 3}));
  EXPECT_EQ(c[4].last(), (Point{4, 4}));
  EXPECT_EQ(parse_svg_path("M0 0L4 4S5 6 7 8").contours[0][1].p[1], (Point{4, 4}));
}

TEST(SvgPath, ArcsAreWithinTheirTolerance) {
  // Half a circle of radius 5 each, in both directions; one that is too small grows.
  for (const char* data :
       {"M-5 0A5 5 0 0 1 5 0A5 5 0 0 1 -5 0", "M-5 0A5 5 30 10 5 0 5 5 0 10-5 0", "M-5 0A1 1 0 01 5 0 2 2 0 01-5 0"}) {
    const Outline circle = parse_svg_path(data);
    for (const Segment& s : circle.contours.at(0))
      for (int i = 0; i <= 8; ++i) EXPECT_NEAR(length(s.at(i / 8.0)), 5, 5e-7) << data;
  }
  // Three quarters of an ellipse turned by 90 degrees: radius 2 along y, 1 along x.
  const Outline large = parse_svg_path("M1 0A2 1 90 1 1 0 -2Z");
  for (std::size_t k = 0; k + 1 < large.contours[0].size(); ++k) {
    const Point p = large.contours[0][k].at(0.5);
    EXPECT_NEAR(p.x * p.x + p.y * p.y / 4, 1, 1e-6);
  }
  EXPECT_NEAR(large.bounds().low.x, -1, 0.01);
}

TEST(SvgPath, ErrorsNameTheCharacter) {
  const std::pair<const char*, const char*> cases[] = {
      {"L1 2", "character 1: expected M, with which every path starts, found 'L'"},
      {"M1", "character 3: expected a number, found the end"},
      {"M1 2,", "character 6: expected a number, found the end"},
      {"M1 2 K", "character 6: expected a command such as M or L, found 'K'"},
      {"M1 nan", "character 4: expected a number, found 'n'"},
      {"M1 2A1 1 0 2 0 3 3", "character 12: expected a flag, 0 or 1, found '2'"},
      {"M1 2L1e999 0", "character 6: a number out of range, found '1'"}};
  for (const auto& [data, message] : cases) {
    try {
      parse_svg_path(data);
      ADD_FAILURE() << data;
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), message);
    }
  }
  EXPECT_TRUE(parse_svg_path("").contours.empty());
}

}  // namespace
}  // namespace zoneplate::sdf
