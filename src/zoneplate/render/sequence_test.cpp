// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/sequence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate {
namespace {

/// A scene that has moved one unit to the right for each second.
Scene moved(double seconds) {
  Scene scene = *make_builtin_scene("checkerboard");
  for (Instance& instance : scene.instances)
    instance.world_from_object = translation({static_cast<float>(seconds), 0, 0}) * instance.world_from_object;
  return scene;
}

struct Loads {
  int scenes = 0, shapes = 0;
  SceneLoader loader() {
    return {[this](double seconds) { return ++scenes, moved(seconds); },
            [this](double seconds) {
              ++shapes;
              Scene scene = moved(seconds);
              for (TextureImage& image : scene.images) image.pixels = TexelImage();
              return scene;
            }};
  }
};

float x_of(const Scene& scene) { return scene.instances.at(0).world_from_object.column[3].x; }

TEST(Sequence, AnAnimatedSceneIsLoadedOncePerFrameAndItsTexturesOnce) {
  Loads loads;
  Sequence sequence(loads.loader(), {}, {.rate = 10, .start = 2, .duration = 4});
  const PreparedScene first = sequence.scene(5);
  EXPECT_FLOAT_EQ(x_of(first.scene()), 2.5f);
  EXPECT_EQ(loads.scenes, 1);
  sequence.scene(5);
  EXPECT_EQ(loads.scenes, 1);
  const PreparedScene second = sequence.scene(6);
  EXPECT_FLOAT_EQ(x_of(second.scene()), 2.6f);
  EXPECT_EQ(loads.scenes, 2);
  EXPECT_EQ(&second.textures(), &first.textures());
  EXPECT_FLOAT_EQ(x_of(first.scene()), 2.5f);  // a copy stays what it was
}

TEST(Sequence, ItsCameraSeesTheWholeAnimationAndStays) {
  Loads loads;
  Sequence sequence(loads.loader(), {}, {.rate = 10, .duration = 4});
  sequence.set_view({}, 1.5f);
  EXPECT_EQ(loads.scenes, 0);
  const Camera camera = sequence.view(0).camera;
  EXPECT_EQ(sequence.view(40).camera.world_from_camera, camera.world_from_camera);
  for (const double seconds : {0.0, 4.0}) {
    const Box box = moved(seconds).bounds();
    for (int i = 0; i < 8; ++i) {
      const float3 p = box.corner(i);
      const float4 clip =
          camera.clip_from_camera(1.5f) * (inverse(camera.world_from_camera) * float4{p.x, p.y, p.z, 1});
      EXPECT_LE(std::abs(clip.x), clip.w * 1.001f);
      EXPECT_LE(std::abs(clip.y), clip.w * 1.001f);
    }
  }
}

TEST(Sequence, AMomentIsTheShapeThenAndLeavesTheSceneAlone) {
  Loads loads;
  Sequence sequence(loads.loader(), {}, {.rate = 10, .duration = 4});
  sequence.set_view({}, 1.5f);
  const SceneView now = sequence.view(10);
  const Moment before = sequence.moment(9);
  EXPECT_FLOAT_EQ(x_of(*before.scene), 0.9f);
  EXPECT_EQ(before.camera.world_from_camera, now.camera.world_from_camera);
  EXPECT_EQ(&sequence.scene(10).scene(), &now.scene.scene());
  EXPECT_EQ(loads.scenes, 1);
}

TEST(Sequence, ATurntableTurnsTheCameraAboutTheCentre) {
  const PreparedScene scene(*make_builtin_scene("teapot:divisions=4"));
  Sequence sequence(scene, {.turntable = 8});
  sequence.set_view({}, 1);
  const float3 centre = scene.scene().bounds().centre();
  const auto eye = [&](double frame) { return xyz(sequence.view(frame).camera.world_from_camera.column[3]) - centre; };
  const float3 start = eye(0), quarter = eye(2), whole = eye(8);
  EXPECT_NEAR(length(whole - start), 0, 1e-3f * length(start));
  EXPECT_NEAR(quarter.y, start.y, 1e-4f);
  EXPECT_NEAR(start.x * quarter.x + start.z * quarter.z, 0, 1e-3f * length(start));
  EXPECT_EQ(&sequence.scene(3).scene(), &scene.scene());
}

TEST(Sequence, ShutterTimesAreTheMiddlesOfEqualParts) {
  EXPECT_DOUBLE_EQ(shutter_time(7, 0.5, 0, 4), 7.0625);
  EXPECT_DOUBLE_EQ(shutter_time(7, 0.5, 3, 4), 7.4375);
  EXPECT_DOUBLE_EQ(shutter_time(7, 1, 0, 1), 7.5);
}

// A point whose light oscillates f times per frame keeps a part of its amplitude, which is the filter's spectrum.
TEST(Shutter, FiltersHaveTheirSpectra) {
  constexpr double pi = 3.14159265358979323846;
  constexpr int count = 2000;
  for (const double open : {0.5, 1.0})
    for (const double f : {0.1, 0.45, 0.9, 1.7}) {
      const auto amplitude = [&](ShutterFilter filter) {
        double sum = 0;
        for (int i = 0; i < count; ++i)
          sum += std::cos(2 * pi * f * (shutter_time(3, open, i, count, filter) - 3 - open / 2));
        return sum / count;
      };
      const double box = std::sin(pi * f * open) / (pi * f * open), deviation = open / std::sqrt(8 * std::log(2));
      EXPECT_NEAR(amplitude(ShutterFilter::Box), box, 1e-5);
      EXPECT_NEAR(amplitude(ShutterFilter::Triangle), box * box, 2e-5);
      EXPECT_NEAR(amplitude(ShutterFilter::Gaussian), std::exp(-2 * pi * pi * f * f * deviation * deviation), 5e-4);
    }
}

}  // namespace
}  // namespace zoneplate
