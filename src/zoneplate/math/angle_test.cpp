// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/angle.h"

#include <gtest/gtest.h>

#include <cmath>

namespace zoneplate {
namespace {

TEST(SineCosine, AgreesWithTheMathematicalLibrary) {
  for (int i = -7000; i <= 7000; ++i) {
    const double angle = i * 0.001 + 0.0003;
    EXPECT_NEAR(sine_cosine(angle).sine, std::sin(angle), 1e-15);
    EXPECT_NEAR(sine_cosine(angle).cosine, std::cos(angle), 1e-15);
  }
  EXPECT_NEAR(sine_cosine(999.5).sine, std::sin(999.5), 1e-12);
}

TEST(SineCosine, IsExactAtZero) {
  EXPECT_EQ(sine_cosine(0).sine, 0);
  EXPECT_EQ(sine_cosine(0).cosine, 1);
}

}  // namespace
}  // namespace zoneplate
