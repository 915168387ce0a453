// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

std::optional<Score> yiq(const DisplayImage& reference, const DisplayImage& test) {
  const Choice choice = choose_metric(metrics(), "yiq_rms:empty=1");
  const Picture a = make_picture(reference), b = make_picture(test);
  return choice.metric->measure({&a, 1}, {&b, 1}, choice.settings);
}

constexpr Display black = {0, 0, 0, 1}, white = {1, 1, 1, 1}, nothing = {0, 0, 0, 0};

TEST(YiqRms, BlackAndWhiteDifferByLumaAlone) {
  // (255)² × 0.5053 relative to the scale's 35215; the decibels are 10 log10 of that ratio.
  const Score score = *yiq(DisplayImage(3, 2, black), DisplayImage(3, 2, white));
  EXPECT_NEAR(score.value, 10 * std::log10(0.5053 * 255 * 255 / 35215), 1e-6);
}

TEST(YiqRms, OnlyWhatTheTestShowsCounts) {
  DisplayImage reference(2, 1, black), test(2, 1, black);
  test(1, 0) = nothing;
  EXPECT_EQ(yiq(reference, test)->value, -std::numeric_limits<double>::infinity());
  EXPECT_GT(yiq(test, reference)->value, -10);  // black beside transparent, which is white
  EXPECT_FALSE(yiq(reference, DisplayImage(2, 1, nothing)));
}

TEST(YiqRms, WhatHasVanishedCountsByDefault) {
  const auto value = [](const DisplayImage& reference, const DisplayImage& test) {
    const Comparands pair{.count = 1,
                          .reference = [&](std::size_t) { return make_picture(reference); },
                          .test = [&](std::size_t) { return make_picture(test); }};
    const Choice choice = choose_metric(metrics(), "yiq_rms");
    return compare(pair, {&choice, 1}, Unfit::Refuse).results[0].value;
  };
  const double whole = 10 * std::log10(0.5053 * 255 * 255 / 35215);
  for (const Display logo : {black, white}) {
    EXPECT_NEAR(value(DisplayImage(2, 1, logo), DisplayImage(2, 1, nothing)), whole, 1e-6);
    EXPECT_NEAR(value(DisplayImage(2, 1, nothing), DisplayImage(2, 1, logo)), whole, 1e-6);
  }
  EXPECT_NEAR(value(DisplayImage(2, 1, black), DisplayImage(2, 1, white)), whole, 1e-6);
}

TEST(YiqRms, PoolsTheRatiosOfFrames) {
  const Choice choice = choose_metric(metrics(), "yiq_rms");
  const double frames[] = {-20, -std::numeric_limits<double>::infinity()};
  EXPECT_NEAR(choice.metric->pool(std::span(frames)), 10 * std::log10(0.01 / std::sqrt(2.0)), 1e-12);
}

}  // namespace
}  // namespace zoneplate::metrics
