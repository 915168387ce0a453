// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/jittered_frame.h"

#include <gtest/gtest.h>

#include "zoneplate/image/tonemap.h"

namespace zoneplate::upscale {
namespace {

TEST(JitteredFrame, TheBackgroundKeepsItsColourUnderEveryToneMapping) {
  const float4 dark{0.05f, 0.1f, 0.02f, 1}, blue{0.3f, 0.45f, 0.7f, 1}, light{0.85f, 0.8f, 0.75f, 1};
  for (const ToneMapping mapping :
       {ToneMapping::None, ToneMapping::Aces, ToneMapping::Neutral, ToneMapping::Agx, ToneMapping::Filmic})
    for (const float exposure : {1.0f, 2.5f})
      for (const float4& background : {default_background, dark, blue, light}) {
        const DisplayOptions display{.mapping = mapping, .exposure = exposure, .background = background};
        const Display c =
            make_display(over_background(LinearImage(1, 1, Linear{0, 0, 0, 0}), display, "test"), display)(0, 0);
        EXPECT_NEAR(c.r, background.x, 0.5 / 255) << static_cast<int>(mapping);
        EXPECT_NEAR(c.g, background.y, 0.5 / 255) << static_cast<int>(mapping);
        EXPECT_NEAR(c.b, background.z, 0.5 / 255) << static_cast<int>(mapping);
        EXPECT_EQ(c.a, 1);
      }
}

}  // namespace
}  // namespace zoneplate::upscale
