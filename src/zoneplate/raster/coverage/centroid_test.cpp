// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/coverage/centroid.h"

#include <gtest/gtest.h>

#include <bit>

namespace zoneplate {
namespace {

TEST(Centroid, RulesAreWhatTheySay) {
  const SamplePattern four = standard_pattern(4);  // (6, 2), (14, 6), (2, 10), (10, 14) sixteenths
  const CentroidTable mean(four, Centroid::Mean), first(four, Centroid::First), centre(four, Centroid::Centre);
  EXPECT_EQ(mean.of(0b0110, 0), (SamplePosition{128, 128}));
  EXPECT_EQ(mean.of(0b0011, 0), (SamplePosition{160, 64}));
  EXPECT_EQ(mean.of(0b0111, 0), (SamplePosition{117, 96}));  // 117.33
  EXPECT_EQ(mean.of(0b01, 2), four[2]);
  EXPECT_EQ(mean.of(0b11, 2), (SamplePosition{96, 192}));
  EXPECT_EQ(first.of(0b1110, 0), four[1]);
  EXPECT_EQ(centre.of(0b1000, 0), SamplePosition{});
  const CentroidTable of_all({{128, 128}, {0, 0}}, Centroid::MeanOfAll);
  EXPECT_EQ(of_all.of(0b10, 0), (SamplePosition{0, 0}));
  EXPECT_EQ(of_all.whole, (SamplePosition{64, 64}));
  for (const CentroidTable* table : {&mean, &first, &centre}) EXPECT_EQ(table->whole, SamplePosition{});
}

TEST(Centroid, SumsOfSixteenPlacesDoNotRunIntoEachOther) {
  const SamplePosition most{255, 255}, least{0, 0};
  std::int32_t sum = 0;
  for (int i = 0; i < 16; ++i) sum += summand(most);
  EXPECT_EQ(mean_position(sum), most);
  EXPECT_EQ(mean_position(summand({255, 0}) + summand(least)), (SamplePosition{128, 0}));
  const SamplePattern sixteen = standard_pattern(16);
  const CentroidTable places(sixteen, Centroid::Mean);
  for (std::uint64_t samples = 1; samples < 65536; samples += 7) {
    std::int32_t all = 0;
    for (std::uint64_t left = samples; left; left &= left - 1)
      all += summand(sixteen[static_cast<std::size_t>(std::countr_zero(left))]);
    ASSERT_EQ(mean_position(all), places.of(samples, 0)) << samples;
  }
}

TEST(Centroid, PlacesOfTrianglesThatShareAPixelHaveItsCentreAsTheirMean) {
  for (const int n : {2, 4, 8}) {
    const CentroidTable places(standard_pattern(n), Centroid::Mean);
    const auto all = (std::uint64_t{1} << n) - 1;
    for (std::uint64_t samples = 1; samples < all; ++samples) {
      const SamplePosition p = places.of(samples, 0), q = places.of(all & ~samples, 0);
      const int count = std::popcount(samples);
      EXPECT_NEAR(p.x * count + q.x * (n - count), 128 * n, n / 2.0);
      EXPECT_NEAR(p.y * count + q.y * (n - count), 128 * n, n / 2.0);
    }
  }
}

}  // namespace
}  // namespace zoneplate
