// SPDX-License-Identifier: Apache-2.0
// Motion between moments whose scenes have other instances. motion_test.cpp follows surface points.
#include "zoneplate/render/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "zoneplate/math/transform.h"
#include "zoneplate/render/prepared_scene.h"

namespace zoneplate {
namespace {

constexpr int grid = 60;  // pixels a side
constexpr Planes of_motion{.object_id = true, .motion = true, .flow = true, .last_position = true, .was_visible = true};

/// Squares of one mesh side by side, one for each object of the list; the scene has three objects.
Scene squares(std::initializer_list<int> objects, float3 moved = {}) {
  Scene scene;
  scene.materials.emplace_back().double_sided = true;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.position = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
  mesh.index = {0, 1, 2, 2, 1, 3};
  for (const char* name : {"a", "b", "c"}) scene.objects.push_back(name);
  for (const int object : objects)
    scene.instances.push_back({0, object, translation(float3{2.0f * static_cast<float>(object) - 2, 0, 0} + moved), 0});
  return scene;
}

Moment moment_of(const Scene& scene) {
  Camera camera;
  camera.is_orthographic = true, camera.half_height = 3;
  camera.world_from_camera = translation(float3{0, 0, 10});
  return {std::make_shared<const Scene>(scene), camera};
}

Frame rendered(const Scene& now, const Scene& last, const Scene& next) {
  RenderOptions options{.width = grid, .height = grid};
  options.last = moment_of(last), options.next = moment_of(next);
  return render(PreparedScene(now), moment_of(now).camera, {.planes = of_motion}, options);
}

struct SeenObject {
  std::uint32_t object = 0;
  float2 motion, flow;
  bool was_visible = false;
};

/// The data at the middle of an object's square.
SeenObject at(const Frame& frame, int object) {
  const int x = grid / 2 + (object - 1) * grid / 3, y = grid / 2;
  return {frame.object_id(x, y), frame.motion(x, y), frame.flow(x, y), frame.was_visible(x, y) != 0};
}

TEST(Motion, ObjectsAtRestStayWhereOthersAppearAndVanish) {
  const Scene all = squares({0, 1, 2});
  for (const Scene& last : {all, squares({1, 2}), squares({2}), squares({2, 1})})
    for (const Scene& next : {all, squares({1, 2}), squares({0, 2})}) {
      const Frame frame = rendered(all, last, next);
      for (const int object : {0, 1, 2}) {
        const SeenObject seen = at(frame, object);
        const bool was_there =
            std::ranges::any_of(last.instances, [&](const Instance& i) { return i.object == object; });
        EXPECT_EQ(seen.object, static_cast<std::uint32_t>(object));
        EXPECT_EQ(seen.motion, (float2{0, 0})) << object;
        EXPECT_EQ(seen.flow, (float2{0, 0})) << object;
        EXPECT_EQ(seen.was_visible, was_there) << object;
      }
    }
}

TEST(Motion, ObjectsMoveByThemselvesWhereOthersAppearAndVanish) {
  const float pixels = 0.5f * grid / 6;
  const Frame frame = rendered(squares({1, 2}), squares({0, 1, 2}, {-0.5f, 0, 0}), squares({2}, {0, 0.5f, 0}));
  const SeenObject first = at(frame, 1), second = at(frame, 2);
  EXPECT_EQ(first.object, 1u);
  EXPECT_NEAR(first.motion.x, pixels, 1e-4f);
  EXPECT_EQ(first.flow, (float2{0, 0}));  // it vanishes
  EXPECT_NEAR(second.motion.x, pixels, 1e-4f);
  EXPECT_NEAR(second.flow.y, -pixels, 1e-4f);
}

// The parts of an object are its meshes: one that is dropped does not shift the others.
TEST(Motion, PartsOfAnObjectAreKnownByTheirNumbers) {
  const auto parts = [](std::initializer_list<int> numbers) {
    Scene scene = squares({0, 1, 2});
    std::vector<Instance> kept;
    for (const int i : numbers) {
      kept.push_back(scene.instances[static_cast<std::size_t>(i)]);
      kept.back().object = 0, kept.back().part = i;
    }
    scene.instances = kept;
    return scene;
  };
  const Frame frame = rendered(parts({0, 1, 2}), parts({1, 2}), parts({0, 2}));
  for (const int part : {0, 1, 2}) {
    EXPECT_EQ(at(frame, part).motion, (float2{0, 0})) << part;
    EXPECT_EQ(at(frame, part).flow, (float2{0, 0})) << part;
  }
}

}  // namespace
}  // namespace zoneplate
