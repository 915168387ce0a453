// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/points_for_test.h"

namespace zoneplate {
namespace {

// A thousand points in a long tilted shape, whose bounding box is much larger than the shape.
Scene cloud() {
  Scene scene = point_scene(1000, {-1, 2, 0.5f}, [](float a, float b, float c) {
    return float3{4 * a + b, 3 * a - c, 2 * b - a};
  });
  Mesh& mesh = scene.meshes[0];
  for (std::uint32_t i = 0; i < 1000; ++i) mesh.index.push_back(i);
  mesh.position.push_back({100, 100, 100});  // unused by primitives
  return scene;
}

TEST(FitScene, TouchesTheMarginAndIsCentred) {
  const Scene scene = cloud();
  for (const float aspect : {0.5f, 1.0f, 1.8f})
    for (const bool is_orthographic : {false, true}) {
      const AutoFit fit{.is_orthographic = is_orthographic};
      const Camera camera = fit_camera(scene, aspect, fit);
      const float4x4 clip_from_world = camera.clip_from_camera(aspect) * inverse(camera.world_from_camera);
      float left = 2, right = -2, bottom = 2, top = -2;
      for (const Instance& instance : scene.instances)
        for (const std::uint32_t i : scene.meshes[0].index) {
          const float3 p = transform_point(instance.world_from_object, scene.meshes[0].position[i]);
          const float4 q = clip_from_world * float4{p.x, p.y, p.z, 1};
          EXPECT_GT(q.z, 0);
          EXPECT_LT(q.z, q.w);
          left = std::min(left, q.x / q.w), right = std::max(right, q.x / q.w);
          bottom = std::min(bottom, q.y / q.w), top = std::max(top, q.y / q.w);
        }
      EXPECT_NEAR(std::max({-left, right, -bottom, top}), 0.9f, 1e-4f);
      EXPECT_NEAR(left + right, 0, 0.04f);
      EXPECT_NEAR(bottom + top, 0, 0.04f);
    }
}

TEST(FitScene, AnEmptySceneHasACamera) {
  const Camera camera = fit_camera(Scene{}, 1, {});
  EXPECT_GT(camera.near, 0);
  EXPECT_GT(camera.far, camera.near);
}

// Instances of a shared mesh that cannot affect the result are skipped; instances with their own meshes are not.
TEST(FitScene, SharedMeshesChangeNoBit) {
  Scene shared = cloud();
  shared.instances.clear();
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Quaternion turn{0, 0.6f, 0, 0.8f};
    const float3 place{50 * unit_float(hash(i, 4)), 9 * unit_float(hash(i, 5)), 50 * unit_float(hash(i, 6))};
    shared.instances.push_back({0, 0, translation(place) * (i % 2 == 0 ? rotation(turn) : float4x4{})});
  }
  Scene own = shared;
  for (std::size_t i = 0; i < own.instances.size(); ++i) {
    own.meshes.push_back(own.meshes[0]);
    own.instances[i].mesh = static_cast<int>(i) + 1;
  }
  for (const float aspect : {0.7f, 1.6f}) {
    const Camera a = fit_camera(shared, aspect, {}), b = fit_camera(own, aspect, {});
    EXPECT_EQ(a.world_from_camera, b.world_from_camera);
    EXPECT_EQ(a.near, b.near);
    EXPECT_EQ(a.far, b.far);
  }
}

}  // namespace
}  // namespace zoneplate
