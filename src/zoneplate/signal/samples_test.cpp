#include "zoneplate/signal/samples.h"

#include <gtest/gtest.h>

#include <set>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

TEST(Samples, StandardPatternsAreSparse) {
  // In every standard pattern no two samples share a row or a column of the 1/16 lattice.
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
  // Every one of n rows and n columns holds exactly one sample.
  for (const char* name : {"rotated", "nrooks"})
    for (const int n : {4, 16, 64}) {
      std::set<int> rows, columns;
      for (const SamplePosition s : named_pattern(name, n)) rows.insert(s.y * n / 256), columns.insert(s.x * n / 256);
      EXPECT_EQ(rows.size(), static_cast<std::size_t>(n)) << name;
      EXPECT_EQ(columns.size(), static_cast<std::size_t>(n)) << name;
    }
  // Sobol's first 16 samples: one in each cell of 4 × 4, of 2 × 8, of 16 × 1.
  for (const auto& [w, h] : {std::pair{4, 4}, {2, 8}, {16, 1}, {1, 16}}) {
    std::set<int> cells;
    for (const SamplePosition s : named_pattern("sobol", 16)) cells.insert(s.x * w / 256 * h + s.y * h / 256);
    EXPECT_EQ(cells.size(), 16u) << w << " × " << h;
  }
  EXPECT_THROW(named_pattern("grid", 5), Error);
  EXPECT_THROW(named_pattern("spiral", 4), Error);
}

}  // namespace
}  // namespace zoneplate
