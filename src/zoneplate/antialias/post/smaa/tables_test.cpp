// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/smaa/tables.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "zoneplate/antialias/charts_for_test.h"

namespace zoneplate::antialias {
namespace {

/// The slots assembled to the texture of 160 × 560.
std::vector<std::uint8_t> whole_area_table() {
  std::vector<std::uint8_t> table;
  for (int slot = 0; slot < 7; ++slot)
    for (std::ptrdiff_t y = 0; y < AreaSlot::size; ++y)
      for (const auto* part : {&area_slot(slot).orthogonal, &area_slot(slot).diagonal})
        table.insert(table.end(), part->begin() + 160 * y, part->begin() + 160 * (y + 1));
  return table;
}

// The checksums below are those of AreaTex.h and SearchTex.h of SMAA 2.8.
std::uint64_t crc_of(const std::vector<std::uint8_t>& bytes) {
  return crc32(0, bytes.data(), static_cast<uInt>(bytes.size()));
}

TEST(SmaaTables, AreasEqualThoseOfVersion28) {
  const std::vector<std::uint8_t> table = whole_area_table();
  ASSERT_EQ(table.size(), 179200u);
  EXPECT_EQ(crc_of(table), 0xed2bc181u);
}

TEST(SmaaTables, SearchLengthsEqualThoseOfVersion28) {
  const std::vector<std::uint8_t> table = make_search_table();
  ASSERT_EQ(table.size(), 1024u);
  EXPECT_EQ(crc_of(table), 0x77423453u);
}

TEST(SmaaTables, ALongStepsAreasAreThoseOfTheLineThroughIt) {
  // Pattern 6 falls from half a pixel above the border to half a pixel below it: the areas of a column are exact.
  for (int length = 1; length < 40; ++length)
    for (int left = 0; left < length; ++left) {
      const AreaPair a = orthogonal_area(left_up | right_down, left, length - 1 - left, 0, true);
      double above = 0, below = 0;
      for (int i = 0; i < 1000; ++i) {
        const double y = 0.5 - (left + (i + 0.5) / 1000) / length;
        (y > 0 ? above : below) += std::abs(y) / 1000;
      }
      ASSERT_NEAR(a.above, above, 1e-6);
      ASSERT_NEAR(a.below, below, 1e-6);
    }
}

TEST(SmaaTables, StepsSeenFromBesideTheCentreAreHalfwayToTheirHalves) {
  // For a sample a quarter of a pixel above or below the centre, the line is displaced by as much. The original uses
  // the mean of that line and of two lines that meet on the border: an error of an eighth of a pixel in the middle of a
  // long step.
  for (const double offset : {-0.25, 0.25})
    for (const int length : {2, 7, 40}) {
      double farthest = 0;
      for (int left = 0; left < length; ++left) {
        const AreaPair a = orthogonal_area(left_up | right_down, left, length - 1 - left, offset, true);
        double above = 0, below = 0, taken = 0, line = 0;
        for (int i = 0; i < 1000; ++i) {
          const double x = (left + (i + 0.5) / 1000) / length, straight = 0.5 + offset - x;
          const double halves = x < 0.5 ? (0.5 + offset) * (1 - 2 * x) : (offset - 0.5) * (2 * x - 1);
          for (const double y : {straight, halves}) (y > 0 ? above : below) += std::abs(y) / 2000;
          taken += (straight + halves) / 2000, line += straight / 1000;
        }
        ASSERT_NEAR(a.above, above, 1e-5) << left;
        ASSERT_NEAR(a.below, below, 1e-5) << left;
        farthest = std::max(farthest, std::abs(taken - line));
      }
      EXPECT_NEAR(farthest, 0.125, 0.125 / length);
    }
}

TEST(SmaaTables, MirroredPatternsHaveMirroredAreas) {
  const auto mirrored = [](int pattern) { return (pattern & 5) << 1 | (pattern & 10) >> 1; };
  const auto turned = [](int pattern) { return (pattern & 3) << 2 | pattern >> 2; };
  for (int pattern = 0; pattern < 16; ++pattern)
    for (int left = 0; left < 9; ++left)
      for (int right = 0; right < 9; ++right)
        for (const double offset : {0.0, 0.25}) {
          const AreaPair a = orthogonal_area(pattern, left, right, offset, true);
          const AreaPair m = orthogonal_area(mirrored(pattern), right, left, offset, true);
          const AreaPair t = orthogonal_area(turned(pattern), left, right, -offset, true);
          // For patterns with three or four ends the line is a choice, which is not symmetric in left and right.
          if (std::popcount(static_cast<unsigned>(pattern)) < 3) {
            ASSERT_NEAR(a.below, m.below, 1e-12) << pattern;
            ASSERT_NEAR(a.above, m.above, 1e-12) << pattern;
          }
          ASSERT_NEAR(a.below, t.above, 1e-12) << pattern;
          ASSERT_NEAR(a.above, t.below, 1e-12) << pattern;
        }
}

}  // namespace
}  // namespace zoneplate::antialias
