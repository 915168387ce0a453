// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/stream/stream_outline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/fit.h"
#include "zoneplate/scene/stream/mesh_stream_for_test.h"

namespace zoneplate {
namespace {

/// Small triangles on a tilted shell with rounded coordinates, so that several corners lie equally far.
Scene tilted_shell(std::uint32_t triangles, std::uint32_t seed) {
  Scene scene;
  scene.materials.emplace_back();
  scene.objects.push_back("shell");
  scene.instances.push_back({});
  Mesh& mesh = scene.meshes.emplace_back();
  std::uint32_t number = 0;
  const auto random = [&] { return 2 * unit_float(hash(number++, seed)) - 1; };
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const float3 centre = normalize({random(), random(), random()}, {0, 1, 0});
    for (int k = 0; k < 3; ++k) {
      const float3 p = centre * 3 + float3{random(), random(), random()} * 0.05f;
      const auto rounded = [](float x) { return std::floor(x * 4) / 4; };
      mesh.position.push_back({rounded(p.x + p.y), rounded(p.y), rounded(p.z)});
    }
  }
  mesh.index.resize(3 * triangles);
  std::iota(mesh.index.begin(), mesh.index.end(), 0u);
  return scene;
}

Scene scene_of_points(const std::vector<float3>& points) {
  Scene scene = tilted_shell(0, 0);
  scene.meshes[0].topology = Topology::Points;
  scene.meshes[0].position = points;
  scene.meshes[0].index.resize(points.size());
  std::iota(scene.meshes[0].index.begin(), scene.meshes[0].index.end(), 0u);
  return scene;
}

TEST(StreamOutline, FewPointsHaveTheCameraOfAll) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const Scene scene = tilted_shell(seed == 0 ? 1 : 100'000, seed);
    for (const int threads : {1, 3})
      with_threads(threads, [&] {
        MeshStream stream(scene);
        const StreamOutline outline(stream, "shell", {});
        EXPECT_EQ(stream.examined, stream.count());
        const AutoFit fit{.azimuth = 0.7f * static_cast<float>(seed), .is_orthographic = seed % 2 == 1};
        const std::vector<float3> points = outline.farthest(fit_directions(outline.bounds(), 1.5f, fit));
        EXPECT_LT(points.size(), 40u);
        const Scene few = scene_of_points(points);
        const Box box = scene.bounds(), of_few = few.bounds();
        EXPECT_EQ(box.low, outline.bounds().low);
        EXPECT_EQ(box.high, of_few.high);
        const Camera expected = fit_camera(scene, 1.5f, fit), found = fit_camera(few, 1.5f, fit);
        for (std::size_t c = 0; c < 4; ++c) {
          const float4 p = expected.world_from_camera.column[c], q = found.world_from_camera.column[c];
          EXPECT_TRUE(p.x == q.x && p.y == q.y && p.z == q.z && p.w == q.w) << seed;
        }
        EXPECT_EQ(expected.near, found.near);
        EXPECT_EQ(expected.far, found.far);
        EXPECT_EQ(expected.half_height, found.half_height);
      });
  }
}

TEST(StreamOutline, RefusesWhatHasToBeInMemory) {
  Scene scene = tilted_shell(20'000, 3);
  scene.meshes[0].position[40'001].y = std::numeric_limits<float>::infinity();
  MeshStream infinite(scene);
  EXPECT_THROW(StreamOutline(infinite, "shell", {}), Error);
  for (float3& p : scene.meshes[0].position) p = {p.x + 1e6f, 0, p.z};
  MeshStream far(scene);
  EXPECT_THROW(StreamOutline(far, "shell", {}), Error);
}

}  // namespace
}  // namespace zoneplate
