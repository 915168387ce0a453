// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

/// The number of pixels that differ, by the metric with these parameters.
double pixels_off(std::string_view name, const DisplayImage& reference, const DisplayImage& test) {
  const Picture a = make_picture(reference), b = make_picture(test);
  const Choice choice = choose_metric(metrics(), name);
  return choice.metric->measure({&a, 1}, {&b, 1}, choice.settings)->more[0].value;
}

/// A dark half beside a light one; the edge covers `coverage` of column 8.
DisplayImage step(float coverage) {
  DisplayImage out(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const float c = 0.2f + 0.6f * (x < 8 ? 0 : x > 8 ? 1 : coverage);
      out(x, y) = {c, c, c, 1};
    }
  return out;
}

TEST(PixelsMetric, CoverageOfEdgesCanBeLeftOut) {
  for (const float coverage : {0.0f, 0.25f, 0.9f, 1.0f}) {
    EXPECT_EQ(pixels_off("pixels", step(0.5f), step(coverage)), 16) << coverage;
    EXPECT_EQ(pixels_off("pixels:antialiasing=1", step(0.5f), step(coverage)), 0) << coverage;
  }
}

TEST(PixelsMetric, WhatOneImageLacksCountsBesideEdges) {
  DisplayImage line = step(0.5f);
  for (int y = 0; y < 16; ++y) line(12, y) = {0.2f, 0.2f, 0.2f, 1};
  EXPECT_EQ(pixels_off("pixels:antialiasing=1", step(0.25f), line), 16);
  EXPECT_EQ(pixels_off("pixels:antialiasing=1", line, step(0.25f)), 16);

  DisplayImage lighter = step(0.5f);
  for (Display& c : lighter.values()) c.g = std::min(c.g + 0.05f, 1.0f);
  EXPECT_EQ(pixels_off("pixels:antialiasing=1", step(0.5f), lighter), 15 * 16);
}

TEST(PixelsMetric, TheToleranceAppliesToTheRangeToo) {
  DisplayImage brighter = step(0);
  for (int y = 0; y < 16; ++y) brighter(8, y) = {0.8f + 3 / 255.0f, 0.8f, 0.8f, 1};
  EXPECT_EQ(pixels_off("pixels:tolerance=2,antialiasing=1", step(0.5f), brighter), 16);
  EXPECT_EQ(pixels_off("pixels:tolerance=3,antialiasing=1", step(0.5f), brighter), 0);
}

}  // namespace
}  // namespace zoneplate::metrics
