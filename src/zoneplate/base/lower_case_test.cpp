// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/lower_case.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

TEST(LowerCase, ChangesAsciiLettersAlone) {
  EXPECT_EQ(lower_case(".GlTF"), ".gltf");
  EXPECT_EQ(lower_case("@AZ[`az{"), "@az[`az{");
  EXPECT_EQ(lower_case("\xc3\x84\xc3\xa4"), "\xc3\x84\xc3\xa4");
  EXPECT_EQ(lower_case(""), "");
}

}  // namespace
}  // namespace zoneplate
