// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/counterparts.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

Scene with(std::initializer_list<std::pair<int, int>> identities) {
  Scene scene;
  for (const auto& [object, part] : identities) scene.instances.push_back({0, object, {}, part});
  return scene;
}

using Indices = std::vector<std::uint32_t>;

TEST(Counterparts, AreFoundByObjectAndPart) {
  const Scene all = with({{0, 0}, {0, 1}, {1, 0}, {2, 0}, {2, 1}});
  EXPECT_EQ(counterparts(all, all), (Indices{0, 1, 2, 3, 4}));
  const Scene some = with({{0, 1}, {2, 0}, {2, 1}});
  EXPECT_EQ(counterparts(all, some), (Indices{no_instance, 0, no_instance, 1, 2}));
  EXPECT_EQ(counterparts(some, all), (Indices{1, 3, 4}));
  EXPECT_EQ(counterparts(some, with({})), (Indices{no_instance, no_instance, no_instance}));
  // As many instances, and others.
  EXPECT_EQ(counterparts(with({{0, 0}, {1, 0}}), with({{1, 0}, {2, 0}})), (Indices{no_instance, 0}));
}

TEST(Counterparts, OfTheSameIdentityAreFoundByOrder) {
  const Scene three = with({{5, 0}, {1, 0}, {5, 0}, {5, 0}}), two = with({{5, 0}, {5, 0}, {1, 0}});
  EXPECT_EQ(counterparts(three, two), (Indices{0, 2, 1, no_instance}));
  EXPECT_EQ(counterparts(two, three), (Indices{0, 2, 1}));
}

}  // namespace
}  // namespace zoneplate
