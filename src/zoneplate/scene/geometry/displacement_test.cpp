// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/displacement.h"

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
  // The middles of the triangles against the bilinear heights there; the tolerance is relative to the side, 2.
  const auto bilinear = [&](float3 p) {
    const float x = std::clamp((p.x + 1) * n / 2 - 0.5f, 0.0f, n - 1.001f),
                y = std::clamp((1 - p.y) * n / 2 - 0.5f, 0.0f, n - 1.001f);
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const float s = x - static_cast<float>(i), t = y - static_cast<float>(j);
    return (value(i, j) * (1 - s) + value(i + 1, j) * s) * (1 - t) +
           (value(i, j + 1) * (1 - s) + value(i + 1, j + 1) * s) * t;
  };
  for (std::size_t i = 0; i < mesh.index.size(); i += 3) {
    float3 middle{};
    for (std::size_t k = 0; k < 3; ++k) middle = middle + mesh.position[mesh.index[i + k]] * (1.0f / 3);
    EXPECT_NEAR(middle.z, 0.5f * bilinear(middle), 0.0041f) << middle.x << " " << middle.y;
  }
  for (const float3 normal : mesh.normal) EXPECT_GT(normal.z, 0.1f);
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
  displace_surfaces(scene, {.max_triangles = 200});
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_LE(scene.meshes[0].index.size() / 3, 200u);
}

}  // namespace
}  // namespace zoneplate
