// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

Comparison measured(const Picture& reference, const Picture& test) {
  const Comparands pictures{.count = 2,
                            .reference = [&](std::size_t) { return reference; },
                            .test = [&](std::size_t) { return test; },
                            .are_frames = true};
  const Choice choices[] = {choose_metric(metrics(), "disocclusion")};
  return compare(pictures, choices, Unfit::Leave);
}

TEST(Disocclusion, IsTheErrorOfUncoveredPixelsAlone) {
  Picture reference = make_picture(DisplayImage(4, 2, {0.5f, 0.5f, 0.5f, 1})), test = reference;
  test.display(0, 0) = {1, 1, 1, 1};           // hidden before: counts
  test.display(1, 0) = {0.5f, 0.5f, 0.5f, 1};  // hidden before, without error
  test.display(2, 0) = {0, 0, 0, 1};           // seen before
  EXPECT_TRUE(measured(reference, test).results.empty());
  reference.is_uncovered = Plane<std::uint8_t>(4, 2);
  EXPECT_TRUE(measured(reference, test).results.empty());
  reference.is_uncovered(0, 0) = reference.is_uncovered(1, 0) = 1;
  const Comparison c = measured(reference, test);
  ASSERT_EQ(c.results.size(), 1u);
  EXPECT_NEAR(c.results[0].value, 0.5 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(c.results[0].score.more[0].value, 2 / 8.0, 1e-12);
}

}  // namespace
}  // namespace zoneplate::metrics
