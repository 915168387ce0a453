// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/view.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

constexpr float degree = 0.017453293f;

float3 eye_of(const Camera& camera) { return xyz(camera.world_from_camera.column[3]); }
float3 forward_of(const Camera& camera) { return -xyz(camera.world_from_camera.column[2]); }
float3 up_of(const Camera& camera) { return xyz(camera.world_from_camera.column[1]); }

void expect_near(float3 found, float3 expected, float tolerance = 1e-5f) {
  EXPECT_LE(length(found - expected), tolerance) << found.x << ' ' << found.y << ' ' << found.z << " is not "
                                                 << expected.x << ' ' << expected.y << ' ' << expected.z;
}

// A cube of side 2 round (10, 0, 0), and a camera that looks at it from +Z.
Scene cube() {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  for (int i = 0; i < 8; ++i)
    mesh.position.push_back({i & 1 ? 11.0f : 9.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
  mesh.index = {0, 1, 2, 3, 4, 5, 6, 7, 0};
  scene.materials.emplace_back();
  scene.instances.emplace_back();
  Camera& camera = scene.cameras.emplace_back();
  camera.world_from_camera.column[3] = {10, 0, 5, 1};
  camera.near = 1, camera.far = 20;
  return scene;
}

TEST(ChooseCamera, ShowsTheWholeSceneThreeQuarterFromAbove) {
  const Camera camera = choose_camera(cube(), {}, 1);
  const float3 forward = forward_of(camera);
  // Azimuth 30, elevation 20: the eye is to the right (+X), above (+Y) and in front (+Z).
  expect_near(-forward, {0.4698463f, 0.3420201f, 0.8137977f}, 1e-4f);
}

// Single-sided surfaces are not drawn from behind.
TEST(ChooseCamera, ShowsFrontFacesIfThereAreAny) {
  Scene plane;
  Mesh& mesh = plane.meshes.emplace_back();
  mesh.position = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  plane.materials.emplace_back();
  plane.instances.emplace_back();
  const auto eye_on = [&](std::vector<std::uint32_t> index, const View& view = {}) {
    plane.meshes[0].index = std::move(index);
    return eye_of(choose_camera(plane, view, 1));
  };
  EXPECT_GT(eye_on({0, 1, 2}).z, 0);
  const float3 behind = eye_on({0, 2, 1});
  EXPECT_LT(behind.z, 0);
  EXPECT_GT(behind.y, 0);
  EXPECT_LT(eye_on({0, 2, 1}, {.is_orthographic = true}).z, 0);
  // Not if the direction is given, or if there are two sides.
  EXPECT_GT(eye_on({0, 2, 1}, {.azimuth = 0.0f}).z, 0);
  EXPECT_GT(eye_on({0, 2, 1, 0, 1, 2}).z, 0);
  plane.materials[0].double_sided = true;
  EXPECT_GT(eye_on({0, 2, 1}).z, 0);
  plane.materials[0].double_sided = false;
  plane.instances[0].world_from_object.column[0].x = -1;  // a mirrored triangle is still seen from its front
  EXPECT_LT(eye_on({0, 2, 1}).z, 0);
  EXPECT_GT(eye_on({0, 1, 2}).z, 0);
  // A ceiling is seen from below.
  plane.instances[0].world_from_object = {};
  for (float3& p : plane.meshes[0].position) p = {p.x, 0, p.y};
  EXPECT_LT(eye_on({0, 1, 2}).y, 0);
  EXPECT_GT(eye_on({0, 2, 1}).y, 0);
}

TEST(ChooseCamera, AzimuthAndElevationChooseTheDirectionOfTheWholeSceneView) {
  expect_near(forward_of(choose_camera(cube(), {.azimuth = 0.0f, .elevation = 0.0f}, 1)), {0, 0, -1});
  expect_near(forward_of(choose_camera(cube(), {.azimuth = 90 * degree, .elevation = 0.0f}, 1)), {-1, 0, 0});
  expect_near(forward_of(choose_camera(cube(), {.azimuth = 0.0f, .elevation = 90 * degree}, 1)), {0, -1, 0});
}

TEST(ChooseCamera, TakesTheScenesCameraUnchanged) {
  const Camera camera = choose_camera(cube(), {.index = 0}, 1);
  EXPECT_EQ(camera.world_from_camera, cube().cameras[0].world_from_camera);
  EXPECT_EQ(camera.near, 1);
  EXPECT_EQ(camera.far, 20);
}

TEST(ChooseCamera, LooksFromThePositionAtTheCentreOfTheScene) {
  const Camera camera = choose_camera(cube(), {.position = double3{10, 0, -7}}, 1);
  expect_near(eye_of(camera), {10, 0, -7});
  expect_near(forward_of(camera), {0, 0, 1});
  expect_near(up_of(camera), {0, 1, 0});
  // The cube is 6 to 8 away.
  EXPECT_LT(camera.near, 6);
  EXPECT_GT(camera.near, 5.9f);
  EXPECT_GT(camera.far, 8);
  EXPECT_LT(camera.far, 8.1f);
}

TEST(ChooseCamera, ExplicitPartsReplaceThoseOfTheBase) {
  const Camera camera = choose_camera(
      cube(), {.index = 0, .focal_point = double3{10, 5, 5}, .view_up = float3{0, 0, -1}, .view_angle = 1.0f}, 1);
  expect_near(eye_of(camera), {10, 0, 5});
  expect_near(forward_of(camera), {0, 1, 0});
  expect_near(up_of(camera), {0, 0, -1});
  EXPECT_EQ(camera.vertical_fov, 1);
}

TEST(ChooseCamera, TurnsOtherCamerasAboutTheirFocalPoint) {
  // From (10, 0, 5), a quarter to the right about the cube's centre is (15, 0, 0), a quarter up is (10, 5, 0).
  expect_near(eye_of(choose_camera(cube(), {.index = 0, .azimuth = 90 * degree}, 1)), {15, 0, 0});
  const Camera above = choose_camera(cube(), {.index = 0, .elevation = 90 * degree}, 1);
  expect_near(eye_of(above), {10, 5, 0});
  expect_near(forward_of(above), {0, -1, 0});
  expect_near(up_of(above), {0, 0, -1});
}

TEST(ChooseCamera, NearStaysAheadOfAnEyeInsideTheScene) {
  const Camera camera = choose_camera(cube(), {.position = double3{10, 0, 0.5}}, 1);
  EXPECT_GT(camera.near, 0);
  EXPECT_LT(camera.near, 1e-4f);
  EXPECT_GT(camera.far, 1.5f);
}

TEST(ChooseCamera, AParallelViewKeepsTheHeightAtTheFocalPointAndShowsAllInFront) {
  const Camera camera =
      choose_camera(cube(), {.position = double3{10, 0, 0.5}, .view_angle = 90 * degree, .is_orthographic = true}, 1);
  EXPECT_TRUE(camera.is_orthographic);
  EXPECT_NEAR(camera.half_height, 0.5f, 1e-5f);  // 0.5 away, tan 45° = 1
  EXPECT_GT(camera.near, 0);
  EXPECT_GT(eye_of(camera).z, 1);
  EXPECT_LT(eye_of(camera).z - camera.far, -1);
}

TEST(ChooseCamera, RefusesWhatCannotBe) {
  EXPECT_THROW(choose_camera(cube(), {.index = 1}, 1), Error);
  EXPECT_THROW(choose_camera({}, {.index = 0}, 1), Error);
  EXPECT_THROW(choose_camera(cube(), {.position = double3{10, 0, 0}}, 1), Error);
}

TEST(ChooseCamera, AnEmptySceneHasACamera) {
  const Camera camera = choose_camera({}, {.position = double3{0, 0, 3}}, 1);
  EXPECT_GT(camera.near, 0);
  EXPECT_GT(camera.far, camera.near);
}

TEST(Enclosing, MovesOnlyPlanesThatCutTheSceneOff) {
  // The cube of side 2 round (10, 0, 0) is 4 to 6 in front of its camera.
  const Scene scene = cube();
  Camera camera = scene.cameras[0];
  camera.near = 1, camera.far = 20;
  EXPECT_EQ(enclosing(camera, scene).near, 1);
  EXPECT_EQ(enclosing(camera, scene).far, 20);
  camera.near = 5;
  EXPECT_GT(enclosing(camera, scene).near, 3.9f);
  EXPECT_LT(enclosing(camera, scene).near, 4);
  EXPECT_EQ(enclosing(camera, scene).far, 20);
  camera.near = 1, camera.far = 5;
  EXPECT_EQ(enclosing(camera, scene).near, 1);
  EXPECT_GT(enclosing(camera, scene).far, 6);
  EXPECT_LT(enclosing(camera, scene).far, 6.1f);
  EXPECT_EQ(enclosing(camera, scene).world_from_camera, camera.world_from_camera);
  EXPECT_EQ(enclosing(camera, Scene()).far, 5);
}

TEST(Enclosing, ReachesTheEyeAndMovesAnOrthographicCameraBack) {
  const Scene scene = cube();
  Camera camera = scene.cameras[0];
  camera.world_from_camera.column[3] = {10, 0, 0, 1};  // inside of it
  camera.near = 0.5f, camera.far = 20;
  EXPECT_GT(enclosing(camera, scene).near, 0);
  EXPECT_LT(enclosing(camera, scene).near, 0.001f);
  camera.is_orthographic = true;
  const Camera moved = enclosing(camera, scene);
  const float step = eye_of(moved).z;
  EXPECT_GT(step, 1);
  EXPECT_LT(moved.near, step - 1);
  EXPECT_GE(moved.far, 20 + step);
  expect_near(forward_of(moved), forward_of(camera));
}

// The same cube in the coordinates of a survey.
TEST(ChooseCamera, TakesPlacesInTheCoordinatesOfTheFile) {
  Scene far = cube();
  far.origin = {500000.1, 5200000.2, 300.3};
  const View near_view{.position = double3{10, 0, -7}, .focal_point = double3{9, 1, 0}};
  const View far_view{.position = far.origin + *near_view.position, .focal_point = far.origin + *near_view.focal_point};
  const Camera near_camera = choose_camera(cube(), near_view, 1), far_camera = choose_camera(far, far_view, 1);
  expect_near(eye_of(far_camera), eye_of(near_camera), 1e-6f);
  expect_near(forward_of(far_camera), forward_of(near_camera), 1e-6f);
}

}  // namespace
}  // namespace zoneplate
