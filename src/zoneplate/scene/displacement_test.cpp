// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/displacement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace zoneplate {
namespace {

/// A square of side 2 in the plane z = 0, with a height map.
Scene square(TexelImage heights) {
  Scene scene;
  scene.images.push_back({"heights", std::move(heights)});
  Material material;
  material.height_texture.image = 0;
  material.height_texture.sampler.wrap_u = material.height_texture.sampler.wrap_v = Wrap::Clamp;
  material.height_scale = 0.5f;
  scene.materials.push_back(material);
  Mesh mesh;
  mesh.position = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.normal.assign(4, {0, 0, 1});
  mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.index = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(mesh);
  scene.objects.push_back("square");
  scene.instances.push_back({});
  return scene;
}

TEST(Displacement, SurfaceIsWithinTheToleranceOfTheHeights) {
  constexpr int n = 32;
  Rgba16Image heights(n, n);
  const auto value = [](int x, int y) {
    const float dx = (static_cast<float>(x) + 0.5f) / n - 0.5f, dy = (static_cast<float>(y) + 0.5f) / n - 0.5f;
    return std::max(0.0f, 1 - 8 * (dx * dx + dy * dy));
  };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) heights(x, y) = {static_cast<std::uint16_t>(value(x, y) * 65535), 0, 0, 65535};
  Scene scene = square(heights);
  displace_surfaces(scene, {.tolerance = 0.002f});
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_LT(scene.materials[0].height_texture.image, 0);
  const Mesh& mesh = scene.meshes[0];
  ASSERT_GT(mesh.index.size() / 3, 100u);
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    const float3 p = mesh.position[v];
    const float r2 = 0.25f * (p.x * p.x + p.y * p.y);
    EXPECT_NEAR(p.z, 0.5f * std::max(0.0f, 1 - 8 * r2), 0.01f) << p.x << " " << p.y;
    EXPECT_GT(mesh.normal[v].z, 0.1f);
  }
}

TEST(Displacement, AWholeTextureOfOneHeightMovesTheSurface) {
  Scene scene = square(Rgba8Image(4, 4, {255, 0, 0, 255}));
  displace_surfaces(scene);
  for (const float3 p : scene.meshes[0].position) EXPECT_FLOAT_EQ(p.z, 0.5f);
  EXPECT_EQ(scene.meshes[0].index.size(), 6u);
}

TEST(Displacement, ALimitGivesAWarning) {
  Rgba8Image checks(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) checks(x, y) = {static_cast<std::uint8_t>((x + y) % 2 * 255), 0, 0, 255};
  Scene scene = square(checks);
  displace_surfaces(scene, {.most_triangles = 200});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_LE(scene.meshes[0].index.size() / 3, 200u);
}

}  // namespace
}  // namespace zoneplate
