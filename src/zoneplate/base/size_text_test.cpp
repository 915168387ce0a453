// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/size_text.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

TEST(SizeText, HasTheLargestUnitThatFits) {
  const std::pair<std::uint64_t, const char*> cases[] = {{0, "0 bytes"},
                                                         {1, "1 byte"},
                                                         {1023, "1023 bytes"},
                                                         {1024, "1 kB"},
                                                         {30000, "29.3 kB"},
                                                         {1023 << 10, "1023 kB"},
                                                         {62914560, "60 MB"},
                                                         {std::uint64_t{1} << 30, "1 GB"},
                                                         {std::uint64_t{11264} << 20, "11 GB"},
                                                         {std::uint64_t{1} << 50, "1048576 GB"}};
  for (const auto& [bytes, text] : cases) EXPECT_EQ(size_text(bytes), text);
}

}  // namespace
}  // namespace zoneplate
