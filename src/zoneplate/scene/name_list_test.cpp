// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/name_list.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

using Texts = std::vector<std::string>;

TEST(NameList, ThingsOfOneNameShareItsText) {
  NameList names;
  names.push_back("tree");
  names.push_back("");
  for (int i = 0; i < 1000; ++i) names.share(0);
  names.push_back("tree");
  EXPECT_EQ(names.size(), 1003u);
  EXPECT_EQ(names.texts(), (Texts{"tree", "", "tree"}));
  EXPECT_EQ(names[1001], "tree");
  EXPECT_EQ(names[1], "");
  EXPECT_EQ(&names[0], &names[1001]);
  EXPECT_EQ(Texts(names.begin(), names.end()).size(), 1003u);
}

TEST(NameList, AreEqualByTheirNames) {
  NameList shared{"a"};
  shared.share(0);
  EXPECT_EQ(shared, (NameList{"a", "a"}));
  EXPECT_NE(shared, (NameList{"a", "b"}));
  EXPECT_NE(shared, (NameList{"a"}));
  NameList copy = shared;
  copy.push_back("b");
  EXPECT_EQ(copy, (Texts{"a", "a", "b"}));
  EXPECT_TRUE(NameList().empty());
}

}  // namespace
}  // namespace zoneplate
