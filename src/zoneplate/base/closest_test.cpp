// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/closest.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

TEST(Closest, FindsTheNameOfLeastEditDistanceIfOneIsNear) {
  constexpr std::string_view names[] = {"fxaa", "smaa", "msaa", "converged", "n"};
  EXPECT_EQ(closest("mssa", names), "msaa");
  EXPECT_EQ(closest("fxa", names), "fxaa");
  EXPECT_EQ(closest("convrgd", names), "converged");
  EXPECT_EQ(closest("raytracing", names), "");
  EXPECT_EQ(closest("m", names), "");  // all letters differ
  EXPECT_EQ(closest("", names), "");
  EXPECT_EQ(closest("msaa", {}), "");
}

}  // namespace
}  // namespace zoneplate
