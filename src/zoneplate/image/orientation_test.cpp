// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/orientation.h"

#include <gtest/gtest.h>

#include <string>

namespace zoneplate {
namespace {

/// The rows of an image of letters.
std::string text_of(const Plane<char>& image) {
  std::string text;
  for (int y = 0; y < image.height(); ++y) text += std::string(image.row(y).begin(), image.row(y).end()) + '/';
  return text;
}

TEST(Orientation, IsThatOfExif) {
  Plane<char> stored(3, 2);
  std::ranges::copy(std::string_view("abcdef"), stored.values().begin());
  const char* const shown[] = {"abc/def/",  "cba/fed/",  "fed/cba/",  "def/abc/",
                               "ad/be/cf/", "da/eb/fc/", "fc/eb/da/", "cf/be/ad/"};
  for (int i = 1; i <= 8; ++i) {
    EXPECT_EQ(text_of(oriented(stored, i)), shown[i - 1]) << i;
    EXPECT_EQ(swaps_sides(i), i > 4);
  }
  EXPECT_EQ(oriented(stored, 0), stored);
  EXPECT_EQ(oriented(stored, 9), stored);
}

}  // namespace
}  // namespace zoneplate
