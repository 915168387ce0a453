// SPDX-License-Identifier: Apache-2.0
// Light behind many layers, for all methods: values above 1 are visible through layers that would hide darker ones.
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/antialias/shots_for_test.h"

namespace zoneplate::antialias {
namespace {

constexpr const char* sampled_methods[] = {"none", "msaa:n=4", "ssaa:n=4", "csaa:n=8,slots=2"};

Material emitting(float strength, AlphaMode mode, float alpha) {
  Material m;
  m.double_sided = true;
  m.alpha_mode = mode;
  m.base_color = {0, 0, 0, alpha};
  m.emissive = {strength, strength / 2, 0};
  return m;
}

/// A quad behind `layers` black layers of alpha ½, each of two triangles larger than the image. Tilted layers intersect
/// each other, so that the order differs within blocks and rows.
Scene veiled(Material behind, int layers, bool is_tilted) {
  Mesh quad;
  quad.position = {{-9, -8, 0}, {9, -8.5f, 0}, {8, 9, 0}, {-9.5f, 9, 0}};
  quad.index = {0, 1, 2, 0, 2, 3};
  Scene scene = facing_scene(quad);
  scene.materials[0] = std::move(behind);
  scene.materials.push_back(emitting(0, AlphaMode::Blend, 0.5f));
  Mesh veils = quad;
  veils.material = 1;
  veils.position.clear(), veils.normal.clear(), veils.index.clear();
  for (int i = 0; i < layers; ++i) {
    const auto first = static_cast<std::uint32_t>(veils.position.size());
    const float z = 0.5f + 0.05f * static_cast<float>(i), tilt = is_tilted ? (i % 2 ? 0.02f : -0.02f) : 0.0f;
    for (const float3 p : quad.position) {
      veils.position.push_back({p.x, p.y, z + tilt * p.x});
      veils.normal.push_back({0, 0, 1});
    }
    for (const std::uint32_t k : quad.index) veils.index.push_back(first + k);
  }
  scene.meshes.push_back(std::move(veils));
  Instance instance;
  instance.mesh = 1;
  scene.instances.push_back(instance);
  return scene;
}

/// Tests for equality within the precision of half floats.
void expect_near(const LinearImage& image, const LinearImage& expected, const char* method) {
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    const Linear p = image.values()[i], q = expected.values()[i];
    const auto near = [](float a, float b) { return std::abs(a - b) <= std::max(0x1p-12f * b, 0x1p-25f); };
    ASSERT_TRUE(near(p.r, q.r) && near(p.g, q.g) && near(p.a, q.a))
        << method << ", pixel " << i << ": " << p.r << " " << q.r << ", " << p.a << " " << q.a;
  }
}

const RenderOptions options{.width = 37, .height = 19};

TEST(DeepLayers, AnOpaqueSurfaceBehindThemIsSeenAsBrightAsItIs) {
  for (const bool is_tilted : {false, true})
    for (const int layers : {25, 32, 60})
      for (const float strength : {1.0f, 1e5f, 1e8f}) {
        const Scene scene = veiled(emitting(strength, AlphaMode::Opaque, 1), layers, is_tilted);
        const LinearImage exact = shot(scene, "analytic", options);
        const float seen = std::ldexp(strength, -layers);
        ASSERT_NEAR(exact(20, 10).r, seen, seen * 1e-5f);
        for (const char* method : sampled_methods) expect_near(shot(scene, method, options), exact, method);
      }
}

TEST(DeepLayers, SoIsABlendedOne) {
  for (const bool is_tilted : {false, true})
    for (const int layers : {25, 40})
      for (const float strength : {1.0f, 1e5f, 1e8f}) {
        const Scene scene = veiled(emitting(strength, AlphaMode::Blend, 0.75f), layers, is_tilted);
        const LinearImage exact = shot(scene, "analytic", options);
        const float seen = std::ldexp(strength * 0.75f, -layers);
        ASSERT_NEAR(exact(20, 10).r, seen, seen * 1e-5f);
        for (const char* method : sampled_methods) expect_near(shot(scene, method, options), exact, method);
      }
}

// With a small capacity for layers, which are then processed in many parts, all methods give the same image.
TEST(DeepLayers, AreTheSameInOnePartAndInMany) {
  const Scene scene = veiled(emitting(100, AlphaMode::Blend, 0.75f), 30, true);
  for (const char* method : sampled_methods) {
    RenderOptions narrow = options;
    narrow.capacity.layer_samples = 3;
    narrow.capacity.screen_vertices = 0;
    EXPECT_EQ(shot(scene, method, narrow), shot(scene, method, options)) << method;
  }
}

}  // namespace
}  // namespace zoneplate::antialias
