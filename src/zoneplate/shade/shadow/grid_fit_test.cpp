// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/grid_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

float random(std::uint32_t a, std::uint32_t b) { return unit_float(hash(a, b, 3)); }

/// Pixels of a bent surface, of which some show nothing, another instance, or a pane above it.
GridNeighbours neighbours(std::uint32_t seed) {
  GridNeighbours near;
  near.count = seed % 2 == 0 ? GridNeighbours::capacity : GridNeighbours::capacity / GridNeighbours::max_per_cell;
  for (int k = 0; k < near.count; ++k) {
    const auto n = static_cast<std::uint32_t>(k) + 64 * seed;
    const float x = 4 * random(n, 0) - 1, y = 4 * random(n, 1) - 1, bend = 0.05f * static_cast<float>(seed % 5);
    near.x[k] = x, near.y[k] = y;
    near.position[0][k] = x, near.position[1][k] = y, near.position[2][k] = bend * x * x;
    const float length = std::sqrt(1 + 4 * bend * bend * x * x);
    near.bend[k] = 0.02f * random(n, 7);
    near.normal[0][k] = -2 * bend * x / length, near.normal[1][k] = 0, near.normal[2][k] = 1 / length;
    near.surface[k] = 1, near.visible[k] = seed % 7 == 0 ? 0.5f : 0.5f + 0.1f * x + 0.04f * random(n, 2);
    const float kind = random(n, 4);
    if (kind < 0.04f) near.visible[k] = GridNeighbours::nothing;
    if (kind > 0.96f) near.visible[k] = GridNeighbours::unlit;
    if (seed % 3 == 0 && kind > 0.5f && kind < 0.55f) near.surface[k] = 2;
    if (seed % 11 == 0 && k % 8 == 0) near.position[2][k] += 0.5f;
  }
  return near;
}

GridReceivers receivers(std::uint32_t seed) {
  GridReceivers out{};
  out.count = 1 + static_cast<int>(seed % 67);
  for (int i = 0; i < out.count; ++i) {
    out.u[i] = random(static_cast<std::uint32_t>(i) + 300 * seed, 5);
    out.v[i] = random(static_cast<std::uint32_t>(i) + 300 * seed, 6);
    const float bend = 0.05f * static_cast<float>(seed % 5),
                length = std::sqrt(1 + 4 * bend * bend * out.u[i] * out.u[i]);
    out.bend[i] = 0.02f * random(static_cast<std::uint32_t>(i) + 300 * seed, 8);
    out.position[0][i] = out.u[i], out.position[1][i] = out.v[i], out.position[2][i] = bend * out.u[i] * out.u[i];
    out.normal[0][i] = -2 * bend * out.u[i] / length, out.normal[2][i] = 1 / length;
    out.surface[i] = 1;
  }
  return out;
}

constexpr GridDensity densities[] = {{0.005f, true}, {0.02f, false}};

TEST(GridFitBits, AreTheSameForAllInstructionSets) {
  for (const GridDensity& density : densities) {
    int known = 0, unknown = 0;
    for (std::uint32_t seed = 0; seed < 500; ++seed) {
      const GridNeighbours near = neighbours(seed);
      const GridReceivers at = receivers(seed);
      float first[GridReceivers::capacity];
      GridFitKernels::scalar.fit(near, at, density, first);
      for (int i = 0; i < at.count; ++i) ++(first[i] == GridNeighbours::nothing ? unknown : known);
      for (const Isa isa : supported_isas()) {
        float found[GridReceivers::capacity];
        GridFitKernels::of(isa).fit(near, at, density, found);
        for (int i = 0; i < at.count; ++i) ASSERT_EQ(found[i], first[i]) << seed << ' ' << i;
      }
    }
    EXPECT_GT(known, 4000);
    EXPECT_GT(unknown, density.has_gaps ? 1000 : 100);
  }
}

// What one receiver gets does not depend on the others.
TEST(GridFitBits, DoNotDependOnTheOtherReceivers) {
  const GridNeighbours near = neighbours(4);
  const GridReceivers all = receivers(66);
  float together[GridReceivers::capacity];
  GridFitKernels::of().fit(near, all, densities[0], together);
  for (int i = 0; i < all.count; ++i) {
    GridReceivers one{};
    one.count = 1;
    one.u[0] = all.u[i], one.v[0] = all.v[i], one.surface[0] = all.surface[i];
    one.bend[0] = all.bend[i];
    for (std::size_t c = 0; c < 3; ++c) one.position[c][0] = all.position[c][i], one.normal[c][0] = all.normal[c][i];
    float alone[GridReceivers::capacity];
    GridFitKernels::of().fit(near, one, densities[0], alone);
    EXPECT_EQ(alone[0], together[i]);
  }
}

// Points between which others may lie do not determine the values below one that rises above their surface; where there
// are no others, its shadow is among their values.
TEST(GridFit, LeavesWhatMayHideBetweenPointsToRays) {
  GridNeighbours near = neighbours(0);
  for (int k = 0; k < near.count; ++k) near.visible[k] = 0.5f, near.surface[k] = 1;
  near.position[2][5] = 1, near.surface[5] = 2,
  near.x[5] = near.y[5] = near.position[0][5] = near.position[1][5] = 0.5f;
  GridReceivers at{};
  at.count = 1, at.u[0] = at.v[0] = at.position[0][0] = at.position[1][0] = 0.5f, at.normal[2][0] = 1,
  at.surface[0] = 1;
  float found[2];
  for (std::size_t d = 0; d < 2; ++d) {
    float visible[GridReceivers::capacity];
    GridFitKernels::of().fit(near, at, densities[d], visible);
    found[d] = visible[0];
  }
  EXPECT_EQ(found[0], GridNeighbours::nothing);
  EXPECT_EQ(found[1], 0.5f);
}

// A smooth surface of few triangles: the normals say that it rises, the triangle that it does not.
TEST(GridFit, TakesPointsOfOneTriangleWhoseNormalsDiffer) {
  GridNeighbours near = neighbours(0);
  GridReceivers at{};
  at.count = 1, at.u[0] = at.v[0] = at.position[0][0] = at.position[1][0] = 0.5f, at.surface[0] = 1;
  constexpr float sine = 0.2f;
  near.count = 12;
  for (int k = 0; k < near.count; ++k) {
    near.visible[k] = 0.5f, near.surface[k] = 1, near.bend[k] = sine * sine;
    near.y[k] = near.position[1][k] = 0.5f;
    near.normal[0][k] = sine, near.normal[1][k] = 0, near.normal[2][k] = std::sqrt(1 - sine * sine);
  }
  at.normal[0][0] = sine, at.normal[2][0] = near.normal[2][0];
  float visible[GridReceivers::capacity];
  at.bend[0] = sine * sine;
  GridFitKernels::of().fit(near, at, densities[1], visible);
  EXPECT_EQ(visible[0], 0.5f);
  at.bend[0] = 0;
  for (float& bend : near.bend) bend = 0;
  GridFitKernels::of().fit(near, at, densities[1], visible);
  EXPECT_EQ(visible[0], GridNeighbours::nothing);
}

}  // namespace
}  // namespace zoneplate
