// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/cvvdp/cvvdp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/charts_for_test.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/cvvdp/pyramid.h"
#include "zoneplate/metrics/cvvdp/sensitivity.h"
#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

double quality(const LinearImage& reference, const LinearImage& test) {
  const Choice choice = choose_metric(metrics(), "cvvdp");
  const Picture a = make_picture(as_codes(reference)), b = make_picture(as_codes(test));
  return choice.metric->measure({&a, 1}, {&b, 1}, choice.settings)->value;
}

TEST(Cvvdp, PublishedQualities) {
  // Computed by the authors' program, whose floats differ from these doubles by less than the tolerance.
  const double published[] = {9.59113, 3.38938, 8.96934, 7.06419};
  for (int which = 0; which < 4; ++which) {
    const ChartPair pair = chart_pair(which);
    EXPECT_NEAR(quality(pair.reference, pair.test), published[which], 1e-4) << which;
  }
}

/// A frame of an edge that moves by a quarter of a pixel per frame; `code_at(side)` is its profile.
template <class CodeAt>
Picture moving_edge(int frame, const CodeAt& code_at) {
  return make_picture(as_codes(make_chart(256, 128, [&](int x, int y) {
    return grey(code_at(0.9950042 * (x - 127.5) + 0.0998334 * (y - 63.5) - 0.25 * frame));
  })));
}

double video_quality(const std::function<Picture(std::size_t)>& reference,
                     const std::function<Picture(std::size_t)>& test, std::size_t count) {
  const std::vector<Choice> choices = {choose_metric(metrics(), "cvvdp_video")};
  return compare({.count = count, .reference = reference, .test = test, .are_frames = true}, choices, Unfit::Refuse)
      .results[0]
      .value;
}

double soft(double side) { return 0.05 + 0.75 * std::clamp(side + 0.5, 0.0, 1.0); }

TEST(Cvvdp, PublishedQualityOfASequence) {
  const auto smooth = [](std::size_t i) { return moving_edge(static_cast<int>(i), soft); };
  const auto jagged = [](std::size_t i) {
    return moving_edge(static_cast<int>(i), [](double side) { return side > 0 ? 0.8 : 0.05; });
  };
  EXPECT_NEAR(video_quality(smooth, jagged, 24), 9.75163, 5e-4);
}

TEST(Cvvdp, FiltersInTimeHaveThePublishedTaps) {
  const auto filters = temporal_filters(60);
  const double centre[] = {0.11317, 0.31451, 0.23755, 0.43322};
  for (std::size_t c = 0; c < 4; ++c) {
    ASSERT_EQ(filters[c].size(), 17u);
    EXPECT_NEAR(filters[c][8], centre[c], 1e-5);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(filters[c][i], filters[c][16 - i], 1e-15);
  }
}

TEST(Cvvdp, AStillSequenceIsAsItsFirstFrame) {
  const OpponentPlanes planes = opponent_planes(chart_pair(2).reference, {});
  const std::vector<OpponentPlanes> frames = {planes, planes, planes};
  const OpponentPlanes filtered = filtered_in_time(frames, temporal_filters(30));
  ASSERT_EQ(filtered.size(), 4u);
  // The sustained filters pass a static image; the transient one suppresses most of it.
  EXPECT_NEAR(filtered[1](17, 9), planes[1](17, 9), 1e-9);
  EXPECT_LT(std::abs(filtered[3](17, 9)), 0.02 * planes[0](17, 9));
}

TEST(Cvvdp, QualityAndDifferenceInvert) {
  for (const double difference : {0.0, 0.01, 0.1, 1.0, 50.0}) {
    EXPECT_NEAR(difference_of(quality_of(difference)), difference, 1e-9 * (1 + difference));
  }
  EXPECT_EQ(quality_of(0), 10);
}

TEST(Sensitivity, PublishedValues) {
  EXPECT_NEAR(Sensitivity(0, 1).at(100), 151.46, 0.01);
  EXPECT_NEAR(Sensitivity(0, 4).at(10), 179.33, 0.01);
  EXPECT_NEAR(Sensitivity(0, 16).at(100), 57.376, 0.002);
  EXPECT_NEAR(Sensitivity(1, 4).at(100), 190.68, 0.01);
  EXPECT_NEAR(Sensitivity(2, 4).at(100), 40.359, 0.002);
  EXPECT_NEAR(Sensitivity(3, 4).at(100), 240.985, 0.01);
  EXPECT_EQ(Sensitivity(0, 1000).at(1e9), Sensitivity(0, 64).at(10000));
}

TEST(Pyramid, KeepsConstantsAndSizes) {
  for (const int width : {16, 17, 19}) {
    const Plane<double> in(width, 21, 0.75);
    const Plane<double> half = reduce(in);
    EXPECT_EQ(half.width(), (width + 1) / 2);
    EXPECT_EQ(half.height(), 11);
    for (const double v : half.values()) EXPECT_NEAR(v, 0.75, 1e-15);
    const Plane<double> whole = expand(half, width, 21);
    for (const double v : whole.values()) EXPECT_NEAR(v, 0.75, 1e-15);
  }
}

TEST(Pyramid, BandsStopAtTheSizeOrAtTheEye) {
  EXPECT_EQ(band_frequencies(256, 128, 75.40245).size(), 7u);
  const std::vector<double> large = band_frequencies(4096, 4096, 75.40245);
  ASSERT_EQ(large.size(), 9u);
  EXPECT_NEAR(large[0], 37.701225, 1e-9);
  EXPECT_NEAR(large[2], 37.701225 * 0.1614, 1e-9);
  EXPECT_LE(large[7], 0.2);
  EXPECT_EQ(large[8], 0.1);
}

}  // namespace
}  // namespace zoneplate::metrics
