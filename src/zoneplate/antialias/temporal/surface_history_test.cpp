// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/surface_history.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/temporal/sequences_for_test.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::antialias {
namespace {

/// A square that moves by half a pixel and a fraction in each frame.
MovingScene passing_square() {
  return square_before_wall([](int i) { return float2{0.6f * static_cast<float>(i), 0.3f * static_cast<float>(i)}; });
}

TEST(SurfaceHistory, NoColourOfAnObjectEntersAnother) {
  const MovingScene moving = passing_square();
  constexpr int frames = 8;
  const LinearImage reference = last_frame(moving, "converged:samples=128", frames);
  const double oracle = rms(last_frame(moving, "oracle-taa", frames), reference);
  EXPECT_LE(oracle, 0.25 * rms(last_frame(moving, "taa", frames), reference));
  EXPECT_LE(oracle, 1.5 * rms(last_frame(moving, "ssaa:pattern=halton,samples=16", frames), reference));
}

TEST(SurfaceHistory, AnObjectThatHasJumpedAwayLeavesNothing) {
  const MovingScene moving = square_before_wall([](int i) { return float2{i < 4 ? -20.0f : 20.0f, 0}; });
  const LinearImage image = last_frame(moving, "oracle-taa", 5);
  const Linear wall = image(48, 4), place = image(48 - 20, 32);
  EXPECT_NEAR(place.r, wall.r, 1e-6);
  EXPECT_NEAR(place.g, wall.g, 1e-6);
}

TEST(SurfaceHistory, AStillSceneConverges) {
  for (const char* name : {"checkerboard", "text-ui"}) {
    const MovingScene moving = still(*make_builtin_scene(name));
    const LinearImage reference = last_frame(moving, "converged:samples=128", 1);
    const double sampled = rms(last_frame(moving, "ssaa:pattern=halton,samples=16", 1), reference);
    const double accumulated = rms(last_frame(moving, "oracle-taa", 48), reference);
    EXPECT_LE(accumulated, 1.25 * sampled) << name << ' ' << accumulated / sampled;
  }
}

TEST(SurfaceHistory, FollowsAChangeOfLight) {
  MovingScene moving = still(*make_builtin_scene("sphere"));
  const Scene dark = moving.scene(0);
  moving.scene = [dark](int i) {
    Scene scene = dark;
    if (i >= 8)
      for (Light& light : scene.lights) light.intensity *= 3;
    return scene;
  };
  const LinearImage reference = last_frame(moving, "ssaa:n=4", 9);
  EXPECT_LE(rms(last_frame(moving, "oracle-taa", 9), reference), 1.5 * rms(last_frame(moving, "none", 9), reference));
}

TEST(SurfaceHistory, AlphaTestsCoverAsMuchAsInTheShadedSamples) {
  const MovingScene moving = still(*make_builtin_scene("foliage"));
  const LinearImage reference = last_frame(moving, "converged:samples=64", 1);
  EXPECT_LE(rms(last_frame(moving, "oracle-taa", 16), reference), 0.3 * rms(last_frame(moving, "none", 1), reference));
}

TEST(SurfaceHistory, BitsDoNotDependOnThreads) {
  const MovingScene moving = passing_square();
  LinearImage one, three;
  with_threads(1, [&] { one = last_frame(moving, "oracle-taa", 4); });
  with_threads(3, [&] { three = last_frame(moving, "oracle-taa", 4); });
  EXPECT_EQ(one, three);
}

}  // namespace
}  // namespace zoneplate::antialias
