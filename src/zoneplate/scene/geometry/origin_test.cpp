// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/origin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

/// A number in [0, 1).
double part(std::uint32_t a, std::uint32_t b) { return hash(a, b) * 0x1p-32; }

double greatest(double3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Places in a cube of this side around a centre; two of them are opposite corners.
std::vector<double3> cube(std::uint32_t seed, double side, double3 centre) {
  std::vector<double3> out;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const double x = i < 2 ? i : part(seed + i, 1), y = i < 2 ? i : part(seed + i, 2),
                 z = i < 2 ? i : part(seed + i, 3);
    out.push_back(centre + double3{(x - 0.5) * side, (y - 0.5) * side, (z - 0.5) * side});
  }
  return out;
}

double3 origin_of(const std::vector<double3>& places) {
  OriginChoice choice;
  for (const double3 p : places) choice.add(p);
  return choice.origin();
}

TEST(OriginChoice, ScenesNearTheirOriginKeepIt) {
  EXPECT_EQ(origin_of({}), double3{});
  EXPECT_EQ(origin_of({{0, 0, 0}}), double3{});
  EXPECT_EQ(origin_of({{3, -60, 0.5}}), double3{});  // seen from a distance of 1
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    const double side = std::ldexp(1 + part(seed, 9), static_cast<int>(hash(seed, 8) % 60) - 30);
    const double3 centre{(part(seed, 4) - 0.5) * 127 * side, (part(seed, 5) - 0.5) * 127 * side,
                         (part(seed, 6) - 0.5) * 127 * side};
    EXPECT_EQ(origin_of(cube(1000 * seed, side, centre)), double3{}) << seed;
  }
}

TEST(OriginChoice, FarScenesGetTheirCentreRoundedToTheirSize) {
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    const double side = std::ldexp(1 + part(seed, 9), static_cast<int>(hash(seed, 8) % 30) - 15);
    const double3 centre{(70 + 1e6 * part(seed, 4)) * side, (part(seed, 5) - 0.5) * 1e7 * side, 0};
    const double3 origin = origin_of(cube(1000 * seed, side, centre));
    EXPECT_LE(greatest(origin - centre), side / 16) << seed;
    EXPECT_NE(origin, double3{}) << seed;
    const double unit = std::ldexp(1.0, std::ilogb(side) - 3);
    EXPECT_EQ(std::fmod(origin.x, unit), 0) << seed;
  }
  EXPECT_EQ(origin_of({{500000.25, 5200000, 100}, {500000.75, 5200001, 100}}), (double3{500000.5, 5200000.5, 100}));
  EXPECT_EQ(origin_of({{70, 0, 0}}), (double3{70, 0, 0}));
}

TEST(OriginChoice, ANearPartDecides) {
  OriginChoice choice;
  for (const double3 p : {double3{5000, 0, 0}, {5001, 0, 0}}) choice.add(p);
  EXPECT_FALSE(choice.is_near());
  choice.add(double3{4000, 0, 0});
  EXPECT_TRUE(choice.is_near());
  EXPECT_EQ(choice.origin(), double3{});
}

TEST(OriginChoice, PlacesOfNoFloatDoNotCount) {
  const double nothing = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(origin_of({{500000, 1, 0}, {nothing, 0, 0}, {0, -infinity, 0}, {1e300, 0, 0}, {500001, 1, 0}}),
            (double3{500000.5, 1, 0}));
}

TEST(OriginChoice, VerticesThatNothingUsesStayFinite) {
  Mesh mesh;
  const float far = -0.9f * std::numeric_limits<float>::max(), step = 0.001f * std::numeric_limits<float>::max();
  mesh.position = {{far, 0, 0}, {far + step, 0, 0}, {far, step, 0}, {-far, 0, 0}};
  mesh.index = {0, 1, 2};
  EXPECT_NE(center_far_mesh(mesh), double3{});
  EXPECT_LE(std::abs(mesh.position[0].x), step);
  EXPECT_EQ(mesh.position[3], float3{});
}

/// A triangle twice: at its own coordinates, and turned by a quarter about z; with a light and a camera.
Scene placed(float3 at) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  for (const float3 p : {float3{0, 0, 0}, {1, 0, 0}, {0, 1, 0.25f}}) mesh.position.push_back(at + p);
  mesh.index = {0, 1, 2};
  scene.instances.resize(2);
  scene.instances[1].world_from_object.column = {
      {{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {at.x + at.y, at.y - at.x + 2, 0, 1}}};
  scene.lights.resize(2);
  scene.lights[0].position = at + float3{0, 0, 4}, scene.lights[1].position = {0, 0, 1};
  scene.lights[1].is_in_camera_space = true;
  scene.cameras.emplace_back().world_from_camera.column[3] = {at.x, at.y, at.z + 8, 1};
  return scene;
}

TEST(CenterFarScene, KeepsEveryPlaceOfTheFile) {
  const Scene before = placed({500000, 5200000, 100});
  Scene after = before;
  center_far_scene(after);
  EXPECT_NE(after.origin, double3{});
  EXPECT_LT(greatest(widened(after.bounds().high)), 4);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t v = 0; v < 3; ++v) {
      const Affine exact = widened(before.instances[i].world_from_object);
      const double3 wanted = transform_point(exact, widened(before.meshes[0].position[v]));
      EXPECT_EQ(after.in_file(transform_point(after.instances[i].world_from_object, after.meshes[0].position[v])),
                wanted);
    }
  EXPECT_EQ(after.in_file(after.lights[0].position), widened(before.lights[0].position));
  EXPECT_EQ(after.lights[1].position, before.lights[1].position);
  EXPECT_EQ(after.in_file(xyz(after.cameras[0].world_from_camera.column[3])),
            widened(xyz(before.cameras[0].world_from_camera.column[3])));
}

TEST(CenterFarScene, LeavesNearScenesAsTheyAre) {
  const Scene before = placed({12.3f, -40.7f, 0.1f});
  Scene after = before;
  center_far_scene(after);
  EXPECT_EQ(after.origin, double3{});
  EXPECT_EQ(after.meshes[0].position, before.meshes[0].position);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(after.instances[i].world_from_object, before.instances[i].world_from_object);
  EXPECT_EQ(after.lights[0].position, before.lights[0].position);
  EXPECT_EQ(after.cameras[0].world_from_camera, before.cameras[0].world_from_camera);
}

TEST(CenterFarScene, TransformsOfDoublesLoseNothing) {
  Scene scene = placed({0, 0, 0});
  const std::vector<Instance> near = scene.instances;
  std::vector<Affine> transforms = {widened(near[0].world_from_object), widened(near[1].world_from_object)};
  for (Affine& t : transforms) t.move = t.move + double3{0.1, 0.2, 0.3};  // no floats
  center_far_scene(scene, transforms);
  EXPECT_EQ(scene.origin, double3{});
  EXPECT_EQ(scene.instances[0].world_from_object, near[0].world_from_object);

  const double3 far{500000.125, 5200000.25, 300.5};
  for (Affine& t : transforms) t.move = t.move + far;
  const Affine exact = transforms[1];
  center_far_scene(scene, transforms);
  EXPECT_LT(greatest(scene.origin - far), 4);
  const double3 found = scene.in_file(transform_point(scene.instances[1].world_from_object, float3{0, 1, 0.25f}));
  EXPECT_LT(greatest(found - transform_point(exact, {0, 1, 0.25})), 1e-6);
}

}  // namespace
}  // namespace zoneplate
