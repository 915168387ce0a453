// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/flip/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/metrics/charts_for_test.h"
#include "zoneplate/metrics/flip/color.h"
#include "zoneplate/metrics/flip/filters.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/metrics/flip/weighted_sums.h"

namespace zoneplate::metrics {
namespace {

double figure(const Score& score, std::string_view name) {
  return std::ranges::find(score.more, name, &Figure::name)->value;
}

Score flip_of_chart(int which) {
  const ChartPair pair = chart_pair(which);
  return score_of_flip(flip_map(pair.reference, pair.test, default_pixels_per_degree));
}

TEST(Flip, PublishedValues) {
  // Computed by the authors' program in float; the results in double differ by less than 5e-5.
  const struct {
    double mean, max;
  } published[] = {{0.004976, 0.388099}, {0.486137, 0.978420}, {0.207604, 0.371382}, {0.151226, 0.726673}};
  for (int which = 0; which < 4; ++which) {
    const Score score = flip_of_chart(which);
    EXPECT_NEAR(score.value, published[which].mean, 1e-4) << which;
    EXPECT_NEAR(figure(score, "max"), published[which].max, 1e-4) << which;
  }
}

TEST(Flip, QuartilesAreWeightedByTheError) {
  // The total error is 0.2 + 0.3 + 0.3 + 0.3, from the least error up; the quartiles follow by hand.
  Plane<float> map(19, 1, 0.0f);
  std::size_t at = 0;
  for (const auto& [value, count] : {std::pair{0.05f, 6}, {0.1f, 3}, {0.025f, 8}, {0.15f, 2}})
    for (int i = 0; i < count; ++i) map.values()[at++] = value;
  const Score score = score_of_flip(map);
  EXPECT_EQ(figure(score, "weighted_first_quartile"), static_cast<double>(0.05f));  // 0.275 of 1.1
  EXPECT_EQ(figure(score, "weighted_median"), static_cast<double>(0.1f));           // 0.55
  EXPECT_EQ(figure(score, "weighted_third_quartile"), static_cast<double>(0.15f));  // 0.825
  EXPECT_EQ(figure(score, "min"), static_cast<double>(0.025f));
  EXPECT_EQ(figure(score, "max"), static_cast<double>(0.15f));
}

TEST(Flip, PublishedValuesOfUnboundedLight) {
  const double published[] = {0.005382, 0.561196, 0.256468, 0.200432};
  for (int which = 0; which < 4; ++which) {
    const ChartPair pair = chart_pair(which);
    const Plane<float> map = hdr_flip_map(brightened(pair.reference), brightened(pair.test), default_pixels_per_degree);
    EXPECT_NEAR(score_of_flip(map).value, published[which], 1e-4) << which;
  }
}

TEST(Flip, PublishedExposures) {
  const auto exposures = [](int which) { return flip_exposures(brightened(chart_pair(which).reference)); };
  EXPECT_EQ(exposures(0).size(), 2u);
  EXPECT_NEAR(exposures(0).front(), -1.27285, 1e-5);
  EXPECT_NEAR(exposures(0).back(), -1.27285, 1e-5);
  EXPECT_NEAR(exposures(1).front(), -1.91670, 1e-5);
  EXPECT_NEAR(exposures(1).back(), 0.07446, 1e-5);
  EXPECT_NEAR(exposures(2).front(), -1.81559, 1e-5);
  EXPECT_NEAR(exposures(2).back(), 0.02063, 1e-5);
  EXPECT_NEAR(exposures(3).front(), -0.44277, 1e-5);
}

TEST(Flip, InfiniteLightHasFiniteExposures) {
  LinearImage burnt(3, 3, Linear{1, 1, 1, 1});
  burnt(1, 1).g = std::numeric_limits<float>::infinity();
  for (const double exposure : flip_exposures(burnt)) EXPECT_TRUE(std::isfinite(exposure));
  EXPECT_LT(flip_exposures(burnt).size(), 200u);
}

TEST(Flip, BlackReferenceHasExposures) {
  const LinearImage black(32, 16, Linear{0, 0, 0, 1});
  EXPECT_EQ(score_of_flip(hdr_flip_map(black, black, 30)).value, 0);
}

TEST(Flip, IsTheSameWhateverTileAPixelIsIn) {
  // The same pixels shifted by 20: the contents of all tiles change, but no value may.
  const ChartPair pair = chart_pair(1);
  const auto moved = [](const LinearImage& image) {
    return make_chart(276, 128, [&](int x, int y) { return image(std::max(0, x - 20), y); });
  };
  const Plane<float> map = flip_map(pair.reference, pair.test, 30);
  const Plane<float> other = flip_map(moved(pair.reference), moved(pair.test), 30);
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 256; ++x) ASSERT_EQ(map(x, y), other(x + 20, y)) << x << ' ' << y;
  }
}

TEST(Flip, OnePixelsDifferenceIsSeenAsFarAsFiltersReachAndNoFarther) {
  // Tiles around which the images agree are skipped: the computed values of their pixels must be 0 too.
  const ChartPair pair = chart_pair(1);
  LinearImage changed = pair.reference;
  changed(64, 61) = {5, 0, 0, 1};
  const Plane<float> map = flip_map(pair.reference, changed, 30);
  const int radius = make_flip_filters(30).radius();
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 256; ++x) {
      const int far = std::max(std::abs(x - 64), std::abs(y - 61));
      if (far <= 1) {
        EXPECT_GT(map(x, y), 0.01) << x << ' ' << y;
      } else if (far > radius) {
        EXPECT_EQ(map(x, y), 0) << x << ' ' << y;
      }
    }
}

TEST(Flip, KernelsSumAsTheirTwins) {
  std::vector<double> from(400);
  for (std::uint32_t i = 0; i < from.size(); ++i) from[i] = hash(i) * 0x1p-32 - 0.5;
  const double taps[] = {0.3, -0.1, 0.7, 0.2, -0.9};
  for (const Isa isa : supported_isas())
    for (std::size_t n = 0; n <= 70; ++n) {
      std::vector<double> expected(80, 7), found = expected;
      FlipKernels::scalar.weighted_sums(from.data(), 71, taps, 5, expected.data(), n);
      FlipKernels::of(isa).weighted_sums(from.data(), 71, taps, 5, found.data(), n);
      ASSERT_EQ(found, expected) << name_of(isa) << ' ' << n;
    }
}

TEST(Flip, FiltersSumAsPromised) {
  const FlipFilters f = make_flip_filters(default_pixels_per_degree);
  EXPECT_EQ(f.color_radius, 10);
  EXPECT_EQ(f.feature_radius, 9);
  const auto sum = [](const Taps& taps) {
    double s = 0;
    for (const double tap : taps) s += tap;
    return s;
  };
  EXPECT_NEAR(sum(f.lightness), 1, 1e-14);
  EXPECT_NEAR(sum(f.red_green), 1, 1e-14);
  const double narrow = sum(f.blue_yellow_narrow), broad = sum(f.blue_yellow_broad);
  EXPECT_NEAR(narrow * narrow + broad * broad, 1, 1e-14);
  EXPECT_NEAR(sum(f.slope), 0, 1e-14);
  EXPECT_NEAR(sum(f.bend), 0, 1e-14);
}

TEST(FlipColor, SpacesInvertAndWhiteIsNeutral) {
  const Triple white = hunt_lab_from_rgb({1, 1, 1});
  EXPECT_NEAR(white.x, 100, 1e-6);
  EXPECT_NEAR(white.y, 0, 1e-5);
  EXPECT_NEAR(white.z, 0, 1e-5);
  // The inverse matrix is the published one, which has nine digits.
  const Triple back = rgb_from_opponent(opponent_from_rgb({0.1, 0.5, 0.9}));
  EXPECT_NEAR(back.x, 0.1, 2e-7);
  EXPECT_NEAR(back.y, 0.5, 2e-7);
  EXPECT_NEAR(back.z, 0.9, 2e-7);
}

TEST(Flip, WeightedMedianSplitsTheError) {
  Plane<float> map(4, 1);
  map.values()[0] = 0.5f, map.values()[1] = 0.125f, map.values()[2] = 0.25f, map.values()[3] = 0.25f;
  const Score score = score_of_flip(map);
  EXPECT_EQ(score.value, 0.28125);
  EXPECT_EQ(figure(score, "weighted_median"), 0.25);  // 0.125 + 0.25 + 0.25 > 1.125 / 2 > 0.125 + 0.25
  EXPECT_EQ(figure(score, "max"), 0.5);
}

TEST(Magma, RunsFromBlackToPaleYellow) {
  EXPECT_EQ(magma(0), (Rgba8{0, 0, 4, 255}));
  EXPECT_EQ(magma(-1), magma(0));
  EXPECT_EQ(magma(0.5f), (Rgba8{183, 55, 121, 255}));
  EXPECT_EQ(magma(1), (Rgba8{252, 253, 191, 255}));
  EXPECT_EQ(magma(2), magma(1));
  const auto lightness = [](int i) {
    const Rgba8 c = magma(static_cast<float>(i) / 255);
    const auto light = [](std::uint8_t code) { return std::pow(code / 255.0, 2.2); };
    return hunt_lab_from_rgb({light(c.r), light(c.g), light(c.b)}).x;
  };
  for (int i = 4; i < 256; i += 4) EXPECT_GT(lightness(i), lightness(i - 4)) << i;
}

}  // namespace
}  // namespace zoneplate::metrics
