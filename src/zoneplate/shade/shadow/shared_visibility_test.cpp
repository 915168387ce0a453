// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/shared_visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "zoneplate/math/random.h"
#include "zoneplate/ray/casters_for_test.h"

namespace zoneplate {
namespace {

constexpr int receiver_count = 160;

/// Points of the plane y = -1.2 under the unit ball.
Receivers receivers_below() {
  Receivers r{};
  r.count = receiver_count;
  for (int i = 0; i < receiver_count; ++i) {
    const float4 p = random_numbers(static_cast<std::uint32_t>(i), 90);
    r.position[0][i] = 2 * p.x - 1, r.position[1][i] = -1.2f, r.position[2][i] = 2 * p.y - 1;
    r.face[1][i] = r.normal[1][i] = 1, r.margin[i] = 1e-6f;
    r.x[i] = static_cast<std::int32_t>(p.z * 16384), r.y[i] = static_cast<std::int32_t>(p.w * 16384);
    r.seed[i] = hash(static_cast<std::uint32_t>(i), 91);
  }
  return r;
}

std::array<std::vector<float>, 2> seen_by(const LightVisibility& visibility, const Receivers& receivers) {
  std::array<std::vector<float>, 2> out{std::vector<float>(Receivers::capacity),
                                        std::vector<float>(Receivers::capacity)};
  visibility.of_light(0, receivers, out[0].data());
  visibility.of_environment(receivers, out[1].data());
  for (std::vector<float>& values : out) values.resize(receiver_count);
  return out;
}

// Where the pixels show nothing to share, every fragment has its own rays.
TEST(SharedVisibility, OwnRaysAreInProportionToTheCoverage) {
  const TestMesh ball = bumpy_sphere(20);
  const Bvh bvh(std::vector{ball.caster()});
  Light light;
  light.kind = LightKind::Directional, light.direction = {0.2f, -1, 0.1f}, light.radius = 0.3f;
  const auto nothing = [](std::span<const PixelPosition>, Receivers&, std::span<bool> found) {
    std::fill(found.begin(), found.end(), false);
  };
  Receivers receivers = receivers_below();
  std::array<float, Receivers::capacity> coverage{};
  std::array<std::uint8_t, Receivers::capacity> halvings{};
  for (std::size_t i = 0; i < receiver_count; ++i) {
    const std::size_t samples = i % 16 + 1;
    coverage[i] = static_cast<float>(samples) / 16;
    halvings[i] = samples > 8 ? 0 : samples > 4 ? 1 : samples > 2 ? 2 : 3;
  }
  for (const int spacing : {1, 8}) {
    const ShadowOptions shadows{.method = ShadowMethod::Soft, .samples = 64, .spacing = spacing};
    const OcclusionOptions occlusion{.samples = 64, .distance = 1e6f, .spacing = spacing};
    const TracedVisibility rays(bvh, {}, {light}, shadows, occlusion);
    const SharedVisibility shared(rays, 1, shadows, occlusion, {64, 64, nothing, nothing});
    EXPECT_TRUE(shared.needs_coverage());
    receivers.coverage = coverage.data(), receivers.halvings = nullptr;
    const auto found = seen_by(shared, receivers);
    if (spacing > 1) receivers.halvings = halvings.data();
    EXPECT_EQ(found, seen_by(rays, receivers)) << spacing;
  }
}

}  // namespace
}  // namespace zoneplate
