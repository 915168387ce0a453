// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/fragment/fragment_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <tuple>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/raster/coverage/coverage.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {
namespace {

/// Owners of eight pixels that share few triangles, some of them nothing's.
struct Owners {
  std::vector<std::int32_t> id;
  CentroidTable centroids;
  OwnerRow row;
  Owners(std::uint32_t seed, int samples)
      : id(static_cast<std::size_t>(samples) * sample_stride),
        centroids(standard_pattern(samples),
                  seed % 5 == 0
                      ? Centroid::First
                      : std::array{Centroid::Mean, Centroid::First, Centroid::Centre, Centroid::MeanOfAll}[seed % 4]) {
    const std::uint32_t kinds = 1 + hash(seed, 1) % 6;
    for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(samples); ++s)
      for (std::uint32_t i = 0; i < 8; ++i) {
        const std::uint32_t at = hash(seed, s, i);
        id[s * sample_stride + i] =
            at % 9 == 0 ? no_primitive : static_cast<std::int32_t>(1000 + (seed % 3 == 0 ? i : 0) + at / 9 % kinds);
      }
    row = {.id = id.data(),
           .sample_count = samples,
           .first_summand = centroids.first.data(),
           .more_summands = centroids.more.data(),
           .whole = centroids.whole,
           .pixel = 8 * (hash(seed, 2) % 512),
           .x = 4096,
           .y = 8192,
           .drawn = seed % 4 == 0 ? hash(seed, 3) % 255 + 1 : 255,
           .is_per_sample = seed % 5 == 0};
  }
};

using Found = std::tuple<std::int32_t, std::int32_t, std::int32_t, std::uint32_t>;  ///< x, y, id, at

std::vector<Found> listed(const OwnerRow& row, Isa isa) {
  const auto list = std::make_unique<FragmentList>();
  FragmentListKernels::of(isa).list(row, *list);
  std::vector<Found> out;
  for (int i = 0; i < list->count; ++i) out.emplace_back(list->x[i], list->y[i], list->id[i], list->at[i]);
  // Different pixels' points may come in any order.
  const auto pixel = [](const Found& f) { return FragmentList::pixel(std::get<3>(f)); };
  std::stable_sort(out.begin(), out.end(), [&](const Found& p, const Found& q) { return pixel(p) < pixel(q); });
  return out;
}

TEST(FragmentList, EverySampleThatIsOwnedColoursFromOnePoint) {
  for (const int samples : {1, 2, 4, 8, 16})
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
      const Owners owners(seed, samples);
      const OwnerRow& row = owners.row;
      std::vector<std::uint32_t> coloured(8);
      std::vector<int> last(8, -1);
      for (const auto& [x, y, id, at] : listed(row, best_isa())) {
        const std::uint32_t lane = FragmentList::pixel(at) - row.pixel, own = FragmentList::samples(at);
        ASSERT_LT(lane, 8u);
        ASSERT_NE(own, 0u);
        EXPECT_EQ(coloured[lane] & own, 0u);
        coloured[lane] |= own;
        for (int s = 0; s < samples; ++s) {
          const bool is_of_point = row.id[s * sample_stride + static_cast<int>(lane)] == id;
          EXPECT_TRUE(is_of_point || (own >> s & 1) == 0);
        }
        const int first = std::countr_zero(own);
        int of_triangle = 0;
        while (row.id[of_triangle * sample_stride + static_cast<int>(lane)] != id) ++of_triangle;
        const int place = row.is_per_sample ? first : 16 * of_triangle + first;
        EXPECT_GT(place, last[lane]) << "in the order of samples, or of their triangles' first samples";
        last[lane] = place;
        const bool is_whole = !row.is_per_sample && own == (1u << samples) - 1;
        const SamplePosition expected = is_whole ? owners.centroids.whole : owners.centroids.of(own, 0);
        EXPECT_EQ(x, row.x + static_cast<std::int32_t>(lane) * 256 + expected.x);
        EXPECT_EQ(y, row.y + expected.y);
        EXPECT_TRUE(!row.is_per_sample || std::has_single_bit(own));
      }
      for (std::size_t lane = 0; lane < 8; ++lane)
        for (int s = 0; s < samples; ++s) {
          const bool is_owned = row.id[static_cast<std::size_t>(s) * sample_stride + lane] != no_primitive &&
                                (row.drawn >> lane & 1) != 0;
          EXPECT_EQ((coloured[lane] >> s & 1) != 0, is_owned) << samples << " samples, seed " << seed;
        }
    }
}

TEST(FragmentList, KernelsGiveTheScalarTwinsBits) {
  for (const Isa isa : supported_isas())
    for (const int samples : {1, 2, 4, 8, 16})
      for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const Owners owners(seed, samples);
        EXPECT_EQ(listed(owners.row, isa), listed(owners.row, Isa::Scalar)) << name_of(isa);
      }

  static FragmentOutputs color;
  std::uint32_t at[FragmentBatch::capacity];
  float weight[FragmentBatch::capacity];
  for (std::uint32_t i = 0; i < FragmentBatch::capacity; ++i) {
    const auto number = [&](std::uint32_t axis) { return unit_float(hash(i, axis)) * 3 - 0.5f; };
    color.r[i] = number(0), color.g[i] = number(1), color.b[i] = number(2), color.a[i] = number(3);
    weight[i] = number(4), at[i] = hash(i, 5) % 8 + (hash(i, 6) % 16 << 12);
  }
  for (const Isa isa : supported_isas())
    for (const int count : {1, 3, 8, 41, 128}) {
      std::vector<float> sum(32, 0.25f), expected = sum;
      FragmentListKernels::of(isa).add(color, at, weight, count, sum.data());
      FragmentListKernels::scalar.add(color, at, weight, count, expected.data());
      EXPECT_EQ(sum, expected) << name_of(isa);
      Linear8 mean, expected_mean;
      FragmentListKernels::of(isa).divide(sum.data(), 3, mean);
      FragmentListKernels::scalar.divide(expected.data(), 3, expected_mean);
      EXPECT_EQ(mean, expected_mean) << name_of(isa);
      EXPECT_EQ(mean.g[7], sum[29] / 3);
    }
}

}  // namespace
}  // namespace zoneplate
