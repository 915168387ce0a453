// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/auto_exposure.h"

#include <gtest/gtest.h>

#include <limits>

namespace zoneplate {
namespace {

TEST(AutoExposure, PutsThe95thPercentileAtFourFifths) {
  LinearImage image(100, 1);
  for (int x = 0; x < 100; ++x) image(x, 0) = {static_cast<float>(x + 1), 0.5f, 0, 1};
  EXPECT_EQ(auto_exposure(image), 0.8f / 96);
}

TEST(AutoExposure, CountsCoveredPixelsWithLight) {
  LinearImage image(8, 1, Linear{0, 0, 0, 1});
  EXPECT_EQ(auto_exposure(image), 1);
  image(0, 0) = {100, 100, 100, 0.25f};  // barely covered
  EXPECT_EQ(auto_exposure(image), 1);
  image(1, 0) = {1, 2, 1, 0.5f};  // premultiplied
  EXPECT_EQ(auto_exposure(image), 0.8f / 4);
}

TEST(AutoExposure, HasLimits) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(auto_exposure(LinearImage(1, 1, Linear{infinity, 0, 0, 1})), 0x1p-100f);
  EXPECT_EQ(auto_exposure(LinearImage(1, 1, Linear{1e-37f, 0, 0, 1})), 0x1p100f);
}

}  // namespace
}  // namespace zoneplate
