// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

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

/// A cube of side 1 at a place, and one at rest in the origin.
Scene cubes_at(float3 place) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  for (int i = 0; i < 8; ++i)
    mesh.position.push_back({i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f});
  mesh.index = {0, 1, 2, 3, 4, 5, 6, 7, 0};
  scene.materials.emplace_back();
  scene.objects.push_back("still"), scene.objects.push_back("moving");
  scene.instances = {{0, 0, {}, 0}, {0, 1, translation(place), 0}};
  return scene;
}

SceneLoader cubes(std::function<float3(double)> place, std::vector<double> key_times = {}) {
  const auto load = [place = std::move(place)](double seconds) { return cubes_at(place(seconds)); };
  return {load, load, [key_times] { return key_times; }};
}

/// Whether all corners of a scene's cubes are in the image, and between the near and the far plane.
bool sees_all(const SceneView& view, float aspect) {
  const Scene& scene = view.scene.scene();
  const float4x4 clip_from_world = view.camera.clip_from_camera(aspect) * inverse(view.camera.world_from_camera);
  for (const Instance& instance : scene.instances)
    for (const float3 p : scene.meshes[0].position) {
      const float3 q = transform_point(instance.world_from_object, p);
      const float4 c = clip_from_world * float4{q.x, q.y, q.z, 1};
      if (!(std::abs(c.x) <= c.w && std::abs(c.y) <= c.w && c.z >= 0 && c.z <= c.w)) return false;
    }
  return true;
}

/// The frames that a sequence's camera does not see wholly.
int unseen_frames(const SceneLoader& loader, const SequenceTiming& timing) {
  Sequence sequence(loader, {}, timing);
  sequence.set_view({}, 1.5f);
  const float4x4 still = sequence.view(0).camera.world_from_camera;
  int unseen = 0;
  for (int frame = 0; frame <= static_cast<int>(timing.duration * timing.rate); ++frame) {
    const SceneView view = sequence.view(frame);
    EXPECT_EQ(view.camera.world_from_camera, still);
    unseen += !sees_all(view, 1.5f);
  }
  return unseen;
}

// Ten seconds at rest, but for a jump towards +z and back that lasts 0.8 s.
TEST(Sequence, ItsCameraSeesAShortJump) {
  const auto jump = [](double t) {
    const double part = std::max(0.0, 1 - std::abs(t - 5) / 0.4);
    return float3{0, 0, static_cast<float>(3 * part)};
  };
  EXPECT_EQ(unseen_frames(cubes(jump, {5, 0, 10, 4.6, 5.4}), {.rate = 24, .duration = 10}), 0);
  EXPECT_EQ(unseen_frames(cubes(jump), {.rate = 24, .duration = 10}), 0);  // by its frames alone
}

// At each of eight evenly spaced times the swing is in its middle.
TEST(Sequence, ItsCameraSeesAnOscillation) {
  const auto swing = [](double t) { return float3{static_cast<float>(3 * std::sin(2 * 3.14159265358979 * t)), 0, 0}; };
  EXPECT_EQ(unseen_frames(cubes(swing), {.rate = 24, .duration = 7}), 0);
}

// A jump at 7,000 of 30,000 frames is seen for its key, which comes first.
TEST(Sequence, ItsCameraSeesTheKeysOfALongAnimation) {
  const auto jump = [](double t) { return float3{t > 700 && t < 701 ? 5.0f : 0.0f, 0, 0}; };
  std::vector<double> keys{700.5, 0, 3000};
  for (int i = 0; i < 1000; ++i) keys.push_back(i * 2.0);
  Sequence sequence(cubes(jump, keys), {}, {.rate = 10, .duration = 3000});
  sequence.set_view({}, 1.5f);
  EXPECT_TRUE(sees_all(sequence.view(7005), 1.5f));
}

// Between the moments that the camera looked at, as within a shutter, nothing is cut off in depth.
TEST(Sequence, NearAndFarPlanesEncloseEachFrame) {
  const auto place = [](double t) {
    const auto is_near = [&](double frame) { return std::abs(t * 24 - frame) < 0.01; };
    return float3{0, 0, is_near(3.4) ? 1.5f : is_near(20.4) ? -40.0f : 0.0f};
  };
  Sequence sequence(cubes(place), {}, {.rate = 24, .duration = 1});
  sequence.set_view({.azimuth = 0.0f, .elevation = 0.0f}, 1.5f);
  const Camera usual = sequence.view(3).camera, near = sequence.view(3.4).camera, far = sequence.view(20.4).camera;
  EXPECT_EQ(sequence.view(4).camera.near, usual.near);
  EXPECT_LT(near.near, usual.near);
  EXPECT_EQ(near.far, usual.far);
  EXPECT_GT(far.far, usual.far);
  EXPECT_EQ(near.world_from_camera, usual.world_from_camera);
  EXPECT_LE(near.near, xyz(usual.world_from_camera.column[3]).z - 2.0f);
  EXPECT_EQ(sequence.moment(3.4).camera.near, near.near);
}

TEST(Sequence, LargeScenesAreLookedAtFewTimes) {
  for (const auto& [vertices, most] : {std::pair(8, 256), {1 << 19, 16}}) {
    int shapes = 0;
    const auto load = [&shapes, vertices = static_cast<std::size_t>(vertices)](double seconds) {
      ++shapes;
      Scene scene = cubes_at({static_cast<float>(seconds), 0, 0});
      scene.meshes[0].position.resize(vertices, float3{static_cast<float>(seconds), 0, 0});
      return scene;
    };
    Sequence sequence({load, load}, {}, {.rate = 24, .duration = 100});
    sequence.set_view({}, 1);
    EXPECT_LE(shapes, most);
    EXPECT_GE(shapes, 16);
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

TEST(Sequence, ATurntableOfASingleSidedSurfaceBeginsInFrontOfIt) {
  Scene plane;
  Mesh& mesh = plane.meshes.emplace_back();
  mesh.position = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.normal.assign(3, {0, 0, -1});
  mesh.index = {0, 2, 1};
  plane.materials.emplace_back();
  plane.objects.push_back("plane");
  plane.instances.emplace_back();
  Sequence sequence(PreparedScene(plane), {.turntable = 4});
  sequence.set_view({}, 1);
  EXPECT_LT(xyz(sequence.view(0).camera.world_from_camera.column[3]).z, 0);
  EXPECT_GT(xyz(sequence.view(2).camera.world_from_camera.column[3]).z, 0);
  sequence.set_view({.azimuth = 0.0f}, 1);
  EXPECT_GT(xyz(sequence.view(0).camera.world_from_camera.column[3]).z, 0);
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
