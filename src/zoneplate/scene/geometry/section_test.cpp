// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/section.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/geometry/solids_for_test.h"

namespace zoneplate {
namespace {

double cap_area(const Scene& scene) {
  double sum = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    if (mesh.name != "section") continue;
    for (std::size_t i = 0; i < mesh.index.size(); i += 3) {
      const float3 a = mesh.position[mesh.index[i]];
      sum += length(cross(mesh.position[mesh.index[i + 1]] - a, mesh.position[mesh.index[i + 2]] - a)) / 2;
    }
  }
  return sum;
}

TEST(Section, ClosesABox) {
  Scene scene = scene_of({box_mesh({{0, 0, 0}, {2, 2, 2}})});
  ASSERT_NEAR(volume_of(scene), 8, 1e-6);
  const SectionPlane plane{{0, 0, 2}, 1};  // z > 0.5
  cut_scene(scene, {&plane, 1});
  EXPECT_NEAR(volume_of(scene), 2, 1e-6);
  EXPECT_NEAR(cap_area(scene), 4, 1e-6);
  EXPECT_FLOAT_EQ(scene.bounds().high.z, 0.5f);
  EXPECT_TRUE(scene.materials[0].double_sided);
  EXPECT_EQ(scene.instances.back().object, 0);
}

TEST(Section, KeepsHollowsAndUnitesOverlaps) {
  const SectionPlane plane{{1, 1, 0.3}, 1.9};
  Scene hollow = scene_of({box_mesh({{0, 0, 0}, {2, 2, 2}}), box_mesh({{0.5f, 0.5f, 0.5f}, {1.5f, 1.5f, 1.5f}}, true)});
  Scene outer = scene_of({box_mesh({{0, 0, 0}, {2, 2, 2}})}),
        inner = scene_of({box_mesh({{0.5f, 0.5f, 0.5f}, {1.5f, 1.5f, 1.5f}})});
  for (Scene* scene : {&hollow, &outer, &inner}) cut_scene(*scene, {&plane, 1});
  EXPECT_NEAR(volume_of(hollow), volume_of(outer) - volume_of(inner), 1e-5);
  EXPECT_NEAR(cap_area(hollow), cap_area(outer) - cap_area(inner), 1e-5);

  Scene both = scene_of({box_mesh({{0, 0, 0}, {2, 2, 2}}), box_mesh({{1, 1, 0}, {3, 3, 2}})});
  const SectionPlane level{{0, 0, 1}, 1};
  cut_scene(both, {&level, 1});
  EXPECT_NEAR(cap_area(both), 7, 1e-5);
}

TEST(Section, SeveralPlanesLeaveWhatIsBeyondNone) {
  Scene scene = scene_of({box_mesh({{0, 0, 0}, {2, 2, 2}})});
  const SectionPlane planes[] = {{{1, 0, 0}, 1}, {{0, -1, 0}, -0.5}, {{0, 0, 1}, 5}};
  cut_scene(scene, planes);
  EXPECT_NEAR(volume_of(scene), 1 * 1.5 * 2, 1e-6);
  EXPECT_NEAR(cap_area(scene), 1.5 * 2 + 1 * 2, 1e-6);
}

TEST(Section, FollowsInstancesAndTheFilesOrigin) {
  Scene scene = scene_of({box_mesh({{0, 0, 0}, {2, 2, 2}})});
  scene.origin = {1e6, 0, 0};
  scene.instances[0].world_from_object = translation({-1, 0, 0}) * scaling({-1, 1, 1});
  ASSERT_NEAR(volume_of(scene), 8, 1e-6);
  const SectionPlane plane{{-1, 0, 0}, -1e6 + 2};  // x < 1e6 - 2; the box is from 1e6 - 3 to 1e6 - 1
  cut_scene(scene, {&plane, 1}, float4{1, 0, 0, 1});
  EXPECT_NEAR(volume_of(scene), 4, 1e-6);
  EXPECT_NEAR(cap_area(scene), 4, 1e-6);
  EXPECT_EQ(scene.materials.back().base_color, (float4{1, 0, 0, 1}));
}

// A curved solid: every direction, at its middle.
TEST(Section, CutsACurvedSolidIntoPartsWithItsVolume) {
  const Scene whole = *make_builtin_scene("sphere");
  const float3 centre = whole.bounds().centre();
  for (const double3 normal : {double3{1, 0, 0}, double3{0, 1, 0}, double3{0, 0, 1}, double3{1, 2, -1}}) {
    Scene near = whole, far = whole;
    const double offset = normal.x * centre.x + normal.y * centre.y + normal.z * centre.z;
    const SectionPlane there{normal, offset}, here{{-normal.x, -normal.y, -normal.z}, -offset};
    cut_scene(near, {&there, 1});
    cut_scene(far, {&here, 1});
    EXPECT_NEAR(cap_area(near), cap_area(far), 1e-4 * cap_area(near) + 1e-9);
    EXPECT_NEAR(volume_of(near) + volume_of(far), volume_of(whole), 1e-4 * std::abs(volume_of(whole)));
  }
}

TEST(Section, LeavesSheetsOpen) {
  Mesh sheet;
  sheet.position = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  sheet.normal.assign(4, {0, 0, 1});
  sheet.uv0 = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  sheet.index = {0, 1, 2, 0, 2, 3};
  Scene scene = scene_of({sheet});
  const SectionPlane plane{{1, 0, 0}, 0.5};
  cut_scene(scene, {&plane, 1});
  ASSERT_EQ(scene.instances.size(), 1u);
  const Mesh& left = scene.meshes[static_cast<std::size_t>(scene.instances[0].mesh)];
  for (std::size_t v = 0; v < left.position.size(); ++v)
    EXPECT_EQ(left.uv0[v], (float2{left.position[v].x, left.position[v].y}));
  EXPECT_FLOAT_EQ(scene.bounds().high.x, 0.5f);
}

TEST(Section, ClipsLinesAndLeavesOutPoints) {
  Mesh lines, points;
  lines.topology = Topology::Lines, points.topology = Topology::Points;
  lines.position = points.position = {{0, 0, 0}, {2, 0, 0}};
  lines.index = points.index = {0, 1};
  Scene scene = scene_of({lines, points});
  const SectionPlane plane{{1, 0, 0}, 0.5};
  cut_scene(scene, {&plane, 1});
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.meshes[static_cast<std::size_t>(scene.instances[0].mesh)].position[1], (float3{0.5f, 0, 0}));
  EXPECT_EQ(scene.meshes[static_cast<std::size_t>(scene.instances[1].mesh)].index.size(), 1u);
}

}  // namespace
}  // namespace zoneplate
