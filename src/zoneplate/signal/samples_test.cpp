// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string_view>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

TEST(Samples, StandardPatternsAreSparse) {
  // In every standard pattern, all samples have distinct rows and distinct columns of the 1/16 lattice.
  for (const int n : {2, 4, 8, 16}) {
    std::set<int> rows, columns;
    for (const SamplePosition s : standard_pattern(n)) {
      EXPECT_EQ(s.x % 16, 0);
      EXPECT_EQ(s.y % 16, 0);
      columns.insert(s.x), rows.insert(s.y);
    }
    EXPECT_EQ(rows.size(), static_cast<std::size_t>(n));
    EXPECT_EQ(columns.size(), static_cast<std::size_t>(n));
  }
  EXPECT_EQ(standard_pattern(4)[0], (SamplePosition{96, 32}));  // (-1/8, -3/8) from the centre
  EXPECT_THROW(standard_pattern(3), Error);
}

TEST(Samples, RotatedGridOfFourIsTheStandardPattern) {
  std::set<std::pair<int, int>> standard, rotated;
  for (const SamplePosition s : standard_pattern(4)) standard.insert({s.x, s.y});
  for (const SamplePosition s : named_pattern("rotated", 4)) rotated.insert({s.x, s.y});
  EXPECT_EQ(standard, rotated);
}

TEST(Samples, PatternsAreStratified) {
  // Each of n rows and n columns contains exactly one sample.
  for (const char* name : {"rotated", "nrooks"})
    for (const int n : {4, 16, 64}) {
      std::set<int> rows, columns;
      for (const SamplePosition s : named_pattern(name, n)) rows.insert(s.y * n / 256), columns.insert(s.x * n / 256);
      EXPECT_EQ(rows.size(), static_cast<std::size_t>(n)) << name;
      EXPECT_EQ(columns.size(), static_cast<std::size_t>(n)) << name;
    }
  EXPECT_THROW(named_pattern("grid", 5), Error);
  EXPECT_THROW(named_pattern("spiral", 4), Error);
}

TEST(Samples, SobolHasOneInTheMiddleOfEveryCell) {
  // 2^k samples: one in each cell of every lattice of 2^a × 2^(k - a) cells and none on a cell's border, so that their
  // mean is the pixel's centre, and no sample is at the pixel's corner, which neighbouring pixels share.
  for (int k = 0; k <= 7; ++k) {
    const int n = 1 << k;
    const SamplePattern pattern = named_pattern("sobol", n);
    for (int w = 1; w <= n; w *= 2) {
      std::set<int> cells;
      for (const SamplePosition s : pattern) cells.insert(s.x * w / 256 * (n / w) + s.y * (n / w) / 256);
      EXPECT_EQ(cells.size(), static_cast<std::size_t>(n)) << w << " × " << n / w;
    }
    int x = 0, y = 0;
    for (const SamplePosition s : pattern) {
      EXPECT_EQ(s.x % (256 / n), 128 / n);
      EXPECT_EQ(s.y % (256 / n), 128 / n);
      x += s.x, y += s.y;
    }
    EXPECT_EQ(x, 128 * n);
    EXPECT_EQ(y, 128 * n);
  }
  // Other counts take the first samples of the next power of two, moved together.
  const SamplePattern eight = named_pattern("sobol", 8), five = named_pattern("sobol", 5);
  for (std::size_t i = 0; i < five.size(); ++i) {
    EXPECT_NEAR(five[i].x - five[0].x, eight[i].x - eight[0].x, 1);
    EXPECT_NEAR(five[i].y - five[0].y, eight[i].y - eight[0].y, 1);
  }
}

TEST(Samples, TheMeanOfEveryPatternIsThePixelsCentre) {
  for (const char* name : {"grid", "rotated", "halton", "r2", "sobol", "nrooks"})
    for (int n = 1; n <= 4096; n += n < 300 ? 1 : 173) {
      const int root = static_cast<int>(std::sqrt(n) + 0.5);
      if (root * root != n && std::string_view(name).ends_with("d")) continue;  // grid, rotated
      double x = 0, y = 0;
      for (const SamplePosition s : named_pattern(name, n)) x += s.x, y += s.y;
      EXPECT_LE(std::abs(x / n - 128), 0.5) << name << ' ' << n;
      EXPECT_LE(std::abs(y / n - 128), 0.5) << name << ' ' << n;
    }
}

TEST(Samples, HaltonsSequenceIsThatOfEngines) {
  EXPECT_EQ(halton_sequence(4), (SamplePattern{{128, 85}, {64, 170}, {192, 28}, {32, 113}}));
  // Moved as a whole, as far as rounding allows: no sample changes its distance from another.
  const SamplePattern published = halton_sequence(16), moved = named_pattern("halton", 16);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(moved[i].x - published[i].x, 7.5, 1);
    EXPECT_NEAR(moved[i].y - published[i].y, 10, 1);
  }
}

}  // namespace
}  // namespace zoneplate
