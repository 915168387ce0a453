// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/scene_bytes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/sample_for_test.h"
#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/scene_bytes_for_test.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

Scene read(const Bytes& bytes, const LoadLimits& limits = {}) {
  std::size_t at = 0;
  ImportBudget budget("file", limits);
  const ByteSource source = [&](void* out, std::size_t size) {
    if (size > bytes.size() - at) throw Error(ErrorKind::Input, "file: ends early");
    std::copy_n(bytes.data() + at, size, static_cast<std::uint8_t*>(out));
    at += size;
  };
  return read_scene(source, budget);
}

/// A scene in which every field differs from its default.
Scene full_scene() {
  const MemoryFile file;
  Scene s = load_gltf(file.write(everything().glb()));
  s.ambient_light = {1, 2, 3};
  s.needs_fill_light = true;
  s.environment = {.color = {3, 2, 1}, .image = 0, .rotation = 0.5f, .strength = 2};
  s.lights[0].is_in_camera_space = true;
  s.origin = {500000.1, 2, 3}, s.up = {0, 0, 1};
  s.variants = {"red", "blue"};
  s.warnings = {"one", ""};
  s.cameras.push_back({.name = "eye", .is_orthographic = true, .half_height = 3, .aspect = 2});
  s.materials[0].double_sided = !s.materials[0].double_sided;
  s.materials[0].exponent = 77;
  MaterialLayers layers{.ior = 2,
                        .specular = 0.5f,
                        .glossiness = 0.25f,
                        .clearcoat = 0.75f,
                        .anisotropy_rotation = -3,
                        .iridescence_thickness_maximum = 500,
                        .thickness = 4,
                        .attenuation_distance = 2,
                        .attenuation_color = {0.5f, 0.25f, 1},
                        .dispersion = 3,
                        .diffuse_transmission = 0.5f};
  layers.sheen_roughness_texture.image = 0;
  s.materials[0].layers = std::make_shared<const MaterialLayers>(layers);
  s.materials[0].solid_texture = {SolidPattern::Wood, 3, 4, 0.25f, 2, false, {0.1f, 0.2f, 0.3f}, {0.5f, 0.6f, 0.7f}};
  s.images.push_back({"deep", Rgba16Image(2, 3, {1, 2, 3, 4})});
  s.images.push_back({"bright", Plane<float4>(1, 2, float4{1e5f, 0.25f, 0, 1})});
  return s;
}

TEST(SceneBytes, BringWholeScenesOver) {
  const Scene scene = full_scene();
  const Bytes bytes = written(scene);
  const Scene other = read(bytes);
  EXPECT_EQ(written(other), bytes);
  ASSERT_EQ(other.meshes.size(), scene.meshes.size());
  EXPECT_EQ(other.meshes[0].position, scene.meshes[0].position);
  EXPECT_EQ(other.meshes[0].index, scene.meshes[0].index);
  EXPECT_EQ(other.meshes.back().topology, scene.meshes.back().topology);
  EXPECT_EQ(other.instances.back().world_from_object, scene.instances.back().world_from_object);
  ASSERT_EQ(other.images.size(), scene.images.size());
  for (std::size_t i = 0; i < scene.images.size(); ++i) EXPECT_EQ(other.images[i].pixels, scene.images[i].pixels);
  EXPECT_EQ(other.materials[0].double_sided, scene.materials[0].double_sided);
  EXPECT_EQ(other.materials[0].base_color_texture.sampler, scene.materials[0].base_color_texture.sampler);
  EXPECT_EQ(other.materials[0].solid_texture, scene.materials[0].solid_texture);
  EXPECT_EQ(other.lights[0].kind, LightKind::Spot);
  EXPECT_TRUE(other.lights[0].is_in_camera_space);
  EXPECT_EQ(other.environment, scene.environment);
  for (const MaterialTextureSlot& slot : material_texture_slots)
    EXPECT_EQ((other.materials[0].*slot.use).image, (scene.materials[0].*slot.use).image) << slot.gltf_name;
  ASSERT_NE(other.materials[0].layers, nullptr);
  const MaterialLayers &l = *other.materials[0].layers, &expected = *scene.materials[0].layers;
  EXPECT_EQ(l.glossiness, expected.glossiness);
  EXPECT_EQ(l.attenuation_color, expected.attenuation_color);
  EXPECT_EQ(l.dispersion, expected.dispersion);
  for (const LayerTextureSlot& slot : layer_texture_slots)
    EXPECT_EQ((l.*slot.use).image, (expected.*slot.use).image) << slot.gltf_name;
  EXPECT_EQ(other.materials.back().layers, nullptr);
  EXPECT_EQ(other.cameras.back().name, "eye");
  EXPECT_EQ(other.animations.size(), scene.animations.size());
  EXPECT_EQ(other.variants, scene.variants);
  EXPECT_EQ(other.warnings, scene.warnings);
}

TEST(SceneBytes, AreNotTrusted) {
  const Bytes good = written(full_scene());
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    Bytes bytes = good;
    for (auto n = 1 + random() % 3; n > 0; --n) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    try {
      expect_sound(read(bytes, {.memory = 1 << 24, .pixels = 1 << 20}));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      ++refused;
    }
    if (HasFatalFailure()) FAIL() << "case " << i;
  }
  EXPECT_GT(refused, 400);
  for (std::size_t n = 0; n < good.size(); n += 5)
    EXPECT_THROW(read({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n)}), Error) << n;
}

TEST(SceneBytes, KeepToTheBudget) {
  const Bytes good = written(full_scene());
  EXPECT_THROW(read(good, {.memory = good.size() / 2}), Error);
  EXPECT_THROW(read(good, {.pixels = 3}), Error);
}

TEST(SceneBytes, SharedNamesStayShared) {
  Scene scene = full_scene();
  const std::size_t before = written(scene).size();
  for (int i = 0; i < 1000; ++i) scene.objects.share(0);
  EXPECT_EQ(written(scene).size(), before + 4000);
  const Scene other = read(written(scene));
  EXPECT_EQ(other.objects, scene.objects);
  EXPECT_EQ(other.objects.texts(), scene.objects.texts());
}

TEST(SceneBytes, ANameThatIsNotThereIsRefused) {
  Scene scene = full_scene();
  scene.objects = NameList({"only"}, std::vector<std::uint32_t>(scene.objects.size(), 0));
  Bytes bytes = written(scene);
  const Bytes name = {'o', 'n', 'l', 'y'};
  const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  ASSERT_NE(at, bytes.end());
  *(at + 12) = 1;  // the index of the first object's name, after the text and the number of objects
  EXPECT_THROW(read(bytes), Error);
}

}  // namespace
}  // namespace zoneplate
