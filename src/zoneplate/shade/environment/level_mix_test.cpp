// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/level_mix.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/environment/random_map_for_test.h"

namespace zoneplate {
namespace {

using F = scalar::Float;

constexpr int many = 1 << 20;

TEST(LevelMix, LookUpsHaveTheSameBits) {
  const RandomMap map;
  for (const float level : {0.0f, 0.4f, 1.0f, 1.49f, 3.6f, 4.0f, 5.3f, 6.9f, 7.0f})
    for (const Isa isa : supported_isas())
      with_isa(isa, [&] {
        const float roughness = map.roughness(level);
        LevelMix mix(map.view, roughness);
        mix.for_lookups(many);
        const MixedLevel mixed = mix.for_lookups(1);
        ASSERT_NE(mixed.texels, nullptr) << level;
        for (std::uint32_t i = 0; i < 300; ++i) {
          const auto number = [&](std::uint32_t k) { return F(unit_float(hash(i, k)) - 0.5f); };
          const Vector<F> d{number(0), number(1), number(2)};
          const Vector<F> a = specular_light(map.view, d, F(roughness)), b = specular_light(map.view, mixed, d);
          EXPECT_TRUE(a.x.v == b.x.v && a.y.v == b.y.v && a.z.v == b.z.v) << level << ' ' << i;
        }
      });
}

TEST(LevelMix, LevelsOfDifferentSizesAreNotMixed) {
  const RandomMap map;
  for (const float level : {1.6f, 2.0f, 3.4f}) {
    LevelMix mix(map.view, map.roughness(level));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(mix.for_lookups(many).texels, nullptr) << level;
  }
}

TEST(LevelMix, FewLookUpsDoNotMix) {
  const RandomMap map;
  LevelMix mix(map.view, map.roughness(5));
  int count = 0;
  while (mix.for_lookups(8).texels == nullptr && count < many) count += 8;
  EXPECT_GT(count, 50);
  EXPECT_LT(count, 600);  // the control points of a level
  EXPECT_EQ(mix.for_lookups(8).side, 8);
}

TEST(LevelMix, ThreadsShareOneMixture) {
  const RandomMap map;
  LevelMix mix(map.view, map.roughness(5));
  const auto control_point = [&] {
    LevelMix alone(map.view, map.roughness(5));
    alone.for_lookups(many);
    return alone.for_lookups(1).texels[100];
  }();
  with_threads(4, [&] {
    parallel_for(2000, [&](std::size_t) {
      const MixedLevel level = mix.for_lookups(8);
      if (level.texels != nullptr) {
        EXPECT_EQ(level.texels[100], control_point);
      }
    });
  });
  EXPECT_NE(mix.for_lookups(8).texels, nullptr);
}

}  // namespace
}  // namespace zoneplate
