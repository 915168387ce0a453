// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/ray/bvh.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <set>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/ray/bvh_build.h"
#include "zoneplate/ray/casters_for_test.h"

namespace zoneplate {
namespace {

/// Checks the tree below a reference: the triangles lie in their boxes, and each one in `found` once.
int check(const Bvh& bvh, std::uint32_t at, const Box& box, int depth,
          std::multiset<std::pair<std::uint32_t, std::uint32_t>>& found) {
  if (at & BvhNode::leaf) {
    const BvhLeaf& leaf = bvh.leaves()[at - BvhNode::leaf];
    for (std::size_t i = 0; i < BvhLeaf::width; ++i) {
      if (std::isnan(leaf.vertex[0][0][i])) continue;
      found.insert({leaf.instance[i], leaf.primitive[i]});
      Box all = box;
      for (const auto& v : leaf.vertex) all.add(float3{v[0][i], v[1][i], v[2][i]});
      EXPECT_TRUE(all.low == box.low && all.high == box.high);
    }
    return depth;
  }
  int deepest = depth;
  const BvhNode& node = bvh.nodes()[at];
  for (std::size_t i = 0; i < BvhNode::width; ++i) {
    const auto corner = [&](int side) {
      return float3{node.bound[side][0][i], node.bound[side][1][i], node.bound[side][2][i]};
    };
    const Box child{corner(0), corner(1)};
    if (child.empty()) continue;
    Box all = box;
    all.add(child);
    EXPECT_TRUE(all.low == box.low && all.high == box.high);
    deepest = std::max(deepest, check(bvh, node.child[i], child, depth + 1, found));
  }
  return deepest;
}

/// The depth of the tree, whose structure is checked.
int checked_depth(const Bvh& bvh) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> found;
  const int depth = check(bvh, 0, {{-inf, -inf, -inf}, {inf, inf, inf}}, 0, found);
  EXPECT_EQ(found.size(), bvh.triangles());
  EXPECT_EQ(std::set(found.begin(), found.end()).size(), found.size());
  return depth;
}

TEST(Bvh, BoxesContainAllTrianglesOnce) {
  const TestMesh sphere = bumpy_sphere(40), soup = triangle_soup(1000, 0.2f);
  const ShadowCaster casters[] = {sphere.caster(), soup.caster()};
  const Bvh bvh(casters);
  EXPECT_EQ(bvh.triangles(), 2 * 40 * 40 + 1000u);
  EXPECT_LT(checked_depth(bvh), 8);
}

TEST(Bvh, HasNoTrianglesThatAreNotFinite) {
  TestMesh mesh = triangle_soup(10, 0.1f);
  mesh.position[4].y = std::numeric_limits<float>::infinity();
  EXPECT_EQ(Bvh(std::vector{mesh.caster()}).triangles(), 9u);
  EXPECT_TRUE(Bvh({}).nodes().empty());
}

// Equal triangles cannot be separated, and triangles whose sizes form a geometric series make the heuristic divide off
// a few at a time.
TEST(Bvh, DepthIsBoundedForAnyTriangles) {
  TestMesh equal, series;
  for (std::uint32_t i = 0; i < 30000; ++i) {
    const float size = std::ldexp(1.0f, -static_cast<int>(i / 300));
    for (std::uint32_t k = 0; k < 3; ++k) {
      equal.position.push_back({k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f, 0});
      series.position.push_back(equal.position.back() * size);
      equal.index.push_back(3 * i + k), series.index.push_back(3 * i + k);
    }
  }
  EXPECT_LT(checked_depth(Bvh(std::vector{equal.caster()})), 8);
  EXPECT_LT(checked_depth(Bvh(std::vector{series.caster()})), Bvh::max_depth);
}

TEST(BvhBits, AreTheSameForAnyNumberOfThreadsAndInstructionSet) {
  const TestMesh sphere = bumpy_sphere(200);
  const auto tree = [&](int threads) {
    std::vector<std::byte> bytes;
    with_threads(threads, [&] {
      const Bvh bvh(std::vector{sphere.caster()});
      const auto nodes = std::as_bytes(bvh.nodes()), leaves = std::as_bytes(bvh.leaves());
      bytes.assign(nodes.begin(), nodes.end());
      bytes.insert(bytes.end(), leaves.begin(), leaves.end());
    });
    return bytes;
  };
  const auto one = tree(1);
  EXPECT_GT(one.size(), 80000u * 40);
  EXPECT_EQ(one, tree(3));
  for (const Isa isa : supported_isas()) EXPECT_EQ(one, with_isa(isa, [&] { return tree(1); })) << name_of(isa);
}

// All divisions by all bins, each with the boxes of its sides.
TEST(BvhSplit, HasTheLeastCostOfAllBins) {
  for (const std::uint32_t n : {5u, 6u, 11u, 40u, 1000u}) {
    const TestMesh soup = triangle_soup(n, 0.2f);
    std::vector<BuildReference> references(n);
    BuildBounds bounds;
    ASSERT_EQ(BuildKernels::of().refer(soup.caster(), 7, 0, n, references.data(), bounds), n);
    const BuildBins bins(bounds.centres, n);
    float least = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
      for (std::int32_t bin = 1; bin < static_cast<std::int32_t>(bins.count); ++bin) {
        BuildBox side[2] = {BuildBox::empty(), BuildBox::empty()};
        std::size_t count[2] = {};
        for (const BuildReference& r : references) {
          const bool is_right = bins.bin_of(r, axis) >= bin;
          side[is_right].add(r.box), ++count[is_right];
        }
        float cost = 0;
        for (int i = 0; i < 2; ++i) cost += side[i].area() * static_cast<float>((count[i] + 3) / 4);
        if (count[0] > 0 && count[1] > 0) least = std::min(least, cost);
      }
    const BuildSplit split = BuildKernels::of().split(references.data(), n, bins);
    EXPECT_EQ(split.cost, least) << n;
    for (const BuildReference& r : references) {
      EXPECT_EQ(r.caster(), 7u);
      BuildBox all = bins.bin_of(r, split.axis) < split.bin ? split.left : split.right;
      const float area = all.area();
      all.add(r.box);
      EXPECT_EQ(all.area(), area);
    }
  }
}

}  // namespace
}  // namespace zoneplate
