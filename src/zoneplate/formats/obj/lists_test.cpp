// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/lists.h"

#include <gtest/gtest.h>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

/// Corners whose uv and normal indices are missing, equal to the position's or independent; the kind changes at some
/// corner.
ObjCorner some_corner(std::uint32_t seed, std::uint32_t i) {
  const auto index = [&](std::uint32_t kind) { return static_cast<std::int32_t>(hash(seed, i, kind) % 1000); };
  ObjCorner c{index(0), -1, -1};
  const auto other = [&](std::uint32_t kind) {
    const std::uint32_t way = (hash(seed, kind) + (i > hash(seed, kind, 7) % 40 ? 1 : 0)) % 3;
    return way == 0 ? -1 : way == 1 ? c.position : index(kind);
  };
  c.uv = other(1), c.normal = other(2);
  return c;
}

TEST(ObjCorners, AreWhatWasPutIn) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    ObjCorners corners;
    std::vector<ObjCorner> expected;
    bool have_normals = true;
    for (std::uint32_t i = 0; i < 60; ++i) {
      const std::size_t keep = i % 13 == 12 ? expected.size() - hash(seed, i) % expected.size() : expected.size();
      corners.shorten(keep), expected.resize(keep);
      expected.push_back(some_corner(seed, i));
      corners.push_back(expected.back());
      ASSERT_EQ(corners.size(), expected.size());
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(corners[i], expected[i]) << seed << " " << i;
      have_normals = have_normals && expected[i].normal >= 0;
    }
    EXPECT_TRUE(!corners.have_normals() || have_normals) << seed;
  }
}

TEST(ObjCorners, OfOneNumberTakeAThirdOfTheRoom) {
  ObjCorners one, three;
  for (std::int32_t i = 0; i < 300; ++i) one.push_back({i, i, i}), three.push_back({i, i + 1, i + 2});
  EXPECT_EQ(one.bytes(), 300 * sizeof(std::int32_t));
  EXPECT_EQ(three.bytes(), 900 * sizeof(std::int32_t));
  EXPECT_TRUE(one.have_normals() && three.have_normals());
}

TEST(ObjElements, AreCountedWhileTheyAreTriangles) {
  ObjElements elements;
  std::vector<ObjElement> expected;
  for (std::uint32_t i = 0; i < 10; ++i) {
    expected.push_back({3 * i, 3, ObjKind::Face});
    elements.push_back(expected.back());
  }
  EXPECT_TRUE(elements.are_triangles());
  EXPECT_EQ(elements.bytes(), 0u);
  expected.push_back({30, 3, ObjKind::Line});
  elements.push_back(expected.back());
  EXPECT_FALSE(elements.are_triangles());
  ASSERT_EQ(elements.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(elements[i], expected[i]);
}

}  // namespace
}  // namespace zoneplate
