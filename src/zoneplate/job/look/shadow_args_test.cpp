// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/look/shadow_args.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

TEST(ShadowArgs, DefaultsAreThoseOfTheLibrary) {
  const ShadowOptions soft = parse_shadows("soft"), map = parse_shadows("map:filter=pcss"), library;
  EXPECT_EQ(soft.angle, library.angle);
  EXPECT_EQ(map.angle, library.angle);
  EXPECT_EQ(soft.samples, library.samples);
}

TEST(ShadowArgs, NameAMethodWithItsParameters) {
  EXPECT_EQ(parse_shadows("none").method, ShadowMethod::None);
  EXPECT_EQ(parse_shadows("hard").method, ShadowMethod::Hard);
  const ShadowOptions soft = parse_shadows("soft:samples=64,angle=90e-1");
  EXPECT_EQ(soft.method, ShadowMethod::Soft);
  EXPECT_EQ(soft.samples, 64);
  EXPECT_NEAR(soft.angle, 0.15707963f, 1e-7f);
  const ShadowOptions map = parse_shadows("map:filter=evsm,size=512,radius=3,bias=0.5");
  EXPECT_EQ(map.method, ShadowMethod::Map);
  EXPECT_EQ(map.map.filter, ShadowFilter::Evsm);
  EXPECT_EQ(map.map.size, 512);
  EXPECT_EQ(map.map.radius, 3);
  EXPECT_EQ(map.map.bias, 0.5f);
  // What is not given is what the library has.
  const ShadowOptions pcf = parse_shadows("map");
  EXPECT_EQ(pcf.map.filter, ShadowMapOptions().filter);
  EXPECT_EQ(pcf.map.size, ShadowMapOptions().size);
  EXPECT_EQ(pcf.map.radius, ShadowMapOptions().radius);
  EXPECT_EQ(parse_shadows("soft").samples, ShadowOptions().samples);
  EXPECT_NEAR(parse_shadows("soft").angle, ShadowOptions().angle, 1e-7f);
  EXPECT_EQ(parse_occlusion("none").samples, 0);
  EXPECT_EQ(parse_occlusion("rays").samples, 32);
  EXPECT_EQ(parse_occlusion("rays:distance=2").distance, 2);
  for (const char* wrong : {"sharp", "hard:samples=2", "soft:samples=0", "map:filter=vsm", "map:size=8"})
    EXPECT_THROW(parse_shadows(wrong), Error) << wrong;
}

}  // namespace
}  // namespace zoneplate
