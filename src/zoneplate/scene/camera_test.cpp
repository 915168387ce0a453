// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace zoneplate {
namespace {

/// The extent of a box's corners in the image, in [-1, 1] of half its size, and in depth.
struct Reach {
  float left = 2, right = -2, bottom = 2, top = -2, front = -1, behind = 2;
};

Reach reach_of(const Box& box, const Camera& camera, float aspect) {
  const float4x4 clip_from_world = camera.clip_from_camera(aspect) * inverse(camera.world_from_camera);
  Reach r;
  for (int i = 0; i < 8; ++i) {
    const float3 p = box.corner(i);
    const float4 q = clip_from_world * float4{p.x, p.y, p.z, 1};
    r.left = std::min(r.left, q.x / q.w), r.right = std::max(r.right, q.x / q.w);
    r.bottom = std::min(r.bottom, q.y / q.w), r.top = std::max(r.top, q.y / q.w);
    r.behind = std::min(r.behind, q.z / q.w), r.front = std::max(r.front, q.z / q.w);
  }
  return r;
}

Box box_of(float3 low, float3 high) {
  Box b;
  b.add(low), b.add(high);
  return b;
}

/// The tightest side touches the margin, the image is centred in both directions, and all is between near and far.
void expect_fits(const Box& box, float aspect, const AutoFit& fit) {
  const Reach r = reach_of(box, fit_camera(box, aspect, fit), aspect);
  const float limit = 1 - 2 * fit.margin;
  EXPECT_NEAR(std::max(r.right, r.top), limit, 2e-5f);
  EXPECT_LE(std::max({-r.left, r.right, -r.bottom, r.top}), limit + 2e-5f);
  EXPECT_NEAR(r.left, -r.right, 2e-5f);
  EXPECT_NEAR(r.bottom, -r.top, 2e-5f);
  EXPECT_LT(r.front, 1.0f);
  EXPECT_GT(r.behind, 0.0f);
}

TEST(FitCamera, ShowsTheWholeBoxAsLargeAsTheMarginAllows) {
  const Box box = box_of({-1, 0.5f, -3}, {2, 1.5f, 4});
  for (const float aspect : {0.3f, 1.0f, 16.0f / 9, 5.0f})
    for (const bool orthographic : {false, true})
      for (const float azimuth : {-2.0f, 0.0f, 0.5235988f, 3.0f})
        for (const float elevation : {-1.5707963f, -0.3f, 0.0f, 0.3490659f, 1.5707963f})
          expect_fits(box, aspect,
                      {.azimuth = azimuth, .elevation = elevation, .is_orthographic = orthographic, .margin = 0.1f});
}

TEST(FitCamera, WorksForBoxesOfAnySize) {
  for (const float s : {1e-30f, 1e-3f, 1.0f, 1e6f, 1e30f})
    for (const bool orthographic : {false, true})
      expect_fits(box_of({-s, -s, -2 * s}, {s, 3 * s, s}), 1.5f, {.is_orthographic = orthographic});
}

TEST(FitCamera, WorksForFlatBoxesAndLines) {
  expect_fits(box_of({-1, 0, -1}, {1, 0, 1}), 1.5f, {});
  expect_fits(box_of({0, 0, 0}, {0, 5, 0}), 1.5f, {});
  // A line parallel to the view axis has no extent: it is in the image, in front of the eye.
  const Box line = box_of({0, 0, -1}, {0, 0, 1});
  for (const bool orthographic : {false, true}) {
    const Camera camera = fit_camera(line, 1, {.azimuth = 0, .elevation = 0, .is_orthographic = orthographic});
    EXPECT_GT(camera.near, 0.0f);
    const Reach r = reach_of(line, camera, 1);
    EXPECT_NEAR(r.right, 0, 1e-5f);
    EXPECT_GT(r.behind, 0.0f);
    EXPECT_LT(r.front, 1.0f);
  }
}

TEST(FitCamera, StandsOneUnitFromAPointOrFromNothing) {
  const float3 at = {4, 5, 6};
  for (const Box& box : {box_of(at, at), Box{}}) {
    const Camera camera = fit_camera(box, 1, {});
    const float3 eye = xyz(camera.world_from_camera.column[3]);
    EXPECT_NEAR(length(eye - (box.empty() ? float3{0, 0, 0} : at)), 1, 1e-6f);
    EXPECT_LT(camera.near, 1.0f);
    EXPECT_GT(camera.far, 1.0f);
  }
}

TEST(FitCamera, LooksFromTheFrontRightAndAbove) {
  const Box box = box_of({-1, -1, -1}, {1, 1, 1});
  const float3 back = xyz(fit_camera(box, 1, {}).world_from_camera.column[2]);
  EXPECT_NEAR(back.x, std::cos(0.3490659f) * std::sin(0.5235988f), 1e-6f);
  EXPECT_NEAR(back.y, std::sin(0.3490659f), 1e-6f);
  EXPECT_NEAR(back.z, std::cos(0.3490659f) * std::cos(0.5235988f), 1e-6f);

  // If +Z is up, the same view is from -Y and +X.
  const Camera z_up = fit_camera(box, 1, {.up = {0, 0, 2}});
  const float3 z_back = xyz(z_up.world_from_camera.column[2]);
  EXPECT_NEAR(z_back.x, back.x, 1e-6f);
  EXPECT_NEAR(z_back.y, -back.z, 1e-6f);
  EXPECT_NEAR(z_back.z, back.y, 1e-6f);
  EXPECT_GT(z_up.world_from_camera.column[1].z, 0.9f);
  EXPECT_NEAR(determinant3(z_up.world_from_camera), 1, 1e-6f);
}

TEST(Camera, KeepsTheFilesOwnFrameInThePicture) {
  Camera camera;
  camera.vertical_fov = 1, camera.aspect = 2;
  const float4x4 own = camera.clip_from_camera(2);
  // A wider image keeps the height, a narrower one the width; pixels remain square.
  const float4x4 wide = camera.clip_from_camera(3), narrow = camera.clip_from_camera(1);
  EXPECT_FLOAT_EQ(wide.column[1].y, own.column[1].y);
  EXPECT_FLOAT_EQ(narrow.column[0].x, own.column[0].x);
  for (const float aspect : {1.0f, 2.0f, 3.0f}) {
    const float4x4 m = camera.clip_from_camera(aspect);
    EXPECT_FLOAT_EQ(m.column[0].x * aspect, m.column[1].y);
  }
  camera.is_orthographic = true, camera.half_height = 3;
  EXPECT_FLOAT_EQ(camera.clip_from_camera(4).column[1].y, 1.0f / 3);
  EXPECT_FLOAT_EQ(camera.clip_from_camera(1).column[0].x, 1.0f / 6);
  EXPECT_FLOAT_EQ(camera.clip_from_camera(1).column[1].y, 1.0f / 6);
}

}  // namespace
}  // namespace zoneplate
