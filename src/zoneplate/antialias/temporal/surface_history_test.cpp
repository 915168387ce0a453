// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/surface_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

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

/// Counts the samples of surfaces at rest which, by the rays, the last frame has not seen.
class HiddenSamples : public Resolver {
 public:
  HiddenSamples(int& hidden, int& all) : hidden_(hidden), all_(all) {}
  Request request(const FrameContext&) override {
    Request request;
    request.samples = {{40, 200}};
    request.rate = Rate::Sample;
    request.planes.object_id = request.planes.was_visible = true;
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    for (std::size_t i = 0; i < frame.object_id.values().size(); ++i) {
      if (frame.object_id.values()[i] == Frame::no_id) continue;
      ++all_;
      if (frame.was_visible.values()[i] == 0) ++hidden_;
    }
    return std::move(frame.color);
  }

 private:
  int &hidden_, &all_;
};

// Behind the rods of the fence, another surface lies at the pixels' centres than at their samples.
TEST(SurfaceHistory, SamplesOfASceneAtRestWereVisible) {
  const MovingScene moving = still(*make_builtin_scene("wires"));
  int hidden = 0, all = 0;
  Renderer renderer(PreparedScene(moving.scene(0)), std::make_unique<HiddenSamples>(hidden, all));
  for (int i = 0; i < 2; ++i) renderer.render(moving.camera(i), moving.settings());
  EXPECT_GT(all, moving.width * moving.height);
  EXPECT_LE(hidden, all / 1000) << hidden << " of " << all;
}

// A bar a fifth of a pixel wide, which moves by one pixel in sixteen rows: most rows have no sample of it near.
TEST(SurfaceHistory, AFirstFrameHasAllOfAThinObject) {
  MovingScene moving = square_before_wall([](int) { return float2{0, 0}; });
  const Scene wall = moving.scene(0);
  moving.scene = [wall](int) {
    constexpr float pixel = 1 / 32.0f, half = 0.1f * pixel, lean = 2 * pixel;
    Scene scene = wall;
    Mesh bar;
    add_quad(bar, {{-half - lean, -1, -1}, {half - lean, -1, -1}, {half + lean, 1, -1}, {-half + lean, 1, -1}});
    scene.meshes.pop_back(), scene.instances.pop_back();
    add_part(scene, unlit("bar", {0, 0, 0}), std::move(bar));
    return scene;
  };
  const LinearImage image = last_frame(moving, "oracle-taa", 1);
  for (int y = 0; y < moving.height; ++y) {
    const float least = std::ranges::min(image.row(y), {}, &Linear::g).g;
    ASSERT_LT(least, 0.29f) << "row " << y;  // of 0.3
  }
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
