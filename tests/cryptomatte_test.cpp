// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/cryptomatte.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>

#include "zoneplate/formats/load.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"

namespace zoneplate {
namespace {

TEST(Cryptomatte, HashesOfKnownTexts) {
  EXPECT_EQ(murmur3(""), 0u);
  EXPECT_EQ(murmur3("hello"), 0x248bfa47u);
  EXPECT_EQ(murmur3("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(murmur3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
  // The specification's own examples.
  EXPECT_EQ(std::bit_cast<std::uint32_t>(cryptomatte_id("bunny")), 0x13851a76u);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(cryptomatte_id("default")), 0x42c9679fu);
}

TEST(Cryptomatte, IdsAreOrdinaryFloats) {
  for (int i = 0; i < 5000; ++i) {
    const float id = cryptomatte_id("thing " + std::to_string(i));
    EXPECT_TRUE(std::isnormal(id));
  }
}

// Two squares side by side in one mesh each, the border through the pixels of column 5 at its middle, and a third one
// beyond the image.
Scene squares() {
  Scene scene = load_scene("checkerboard");
  scene.meshes.clear(), scene.instances.clear();
  scene.objects = {"left", "right", "far"};
  scene.materials.resize(2);
  scene.materials[0].name = "a \"quoted\" one", scene.materials[1].name = "";
  const float edges[][2] = {{-5, 0.5f}, {0.5f, 3}, {20, 30}};
  for (int i = 0; i < 3; ++i) {
    const float l = edges[i][0], r = edges[i][1];
    scene.meshes.push_back({.position = {{l, -5, 0}, {r, -5, 0}, {r, 5, 0}, {l, 5, 0}},
                            .normal = std::vector<float3>(4, {0, 0, 1}),
                            .index = {0, 1, 2, 0, 2, 3},
                            .material = i == 1 ? 1 : 0});
    scene.instances.push_back({.mesh = i, .object = i});
  }
  return scene;
}

Frame frame_of(const Scene& scene) {
  const Camera camera{
      .world_from_camera = float4x4{{float4{1, 0, 0, 0}, float4{0, 1, 0, 0}, float4{0, 0, 1, 0}, float4{0, 0, 5, 1}}},
      .is_orthographic = true,
      .half_height = 5,
      .near = 1,
      .far = 10};
  return render(PreparedScene(scene), camera, {.samples = standard_pattern(4), .planes = {.sample_triangles = true}},
                {.width = 10, .height = 10});
}

TEST(Cryptomatte, SharesAreRanked) {
  const Scene scene = squares();
  const Cryptomatte matte = make_cryptomatte(frame_of(scene), scene, MatteKind::Object);
  ASSERT_EQ(matte.ranks.size(), 3u);
  const float left = cryptomatte_id("left"), right = cryptomatte_id("right");
  EXPECT_EQ(matte.ranks[0](2, 5), (float4{left, 1, 0, 0}));
  EXPECT_EQ(matte.ranks[0](6, 5), (float4{right, 1, 0, 0}));
  EXPECT_EQ(matte.ranks[0](5, 5), (float4{left, 0.5f, right, 0.5f}));  // two of four samples are left of the middle
  EXPECT_EQ(matte.ranks[0](9, 5), (float4{0, 0, 0, 0}));
  EXPECT_EQ(matte.ranks[1](5, 5), (float4{0, 0, 0, 0}));
}

TEST(Cryptomatte, AttributesNameAllThings) {
  const Scene scene = squares();
  const Frame frame = frame_of(scene);
  const auto all = [&](MatteKind kind) {
    const Cryptomatte matte = make_cryptomatte(frame, scene, kind);
    return std::map<std::string, std::string>(matte.attributes.begin(), matte.attributes.end());
  };
  const auto objects = all(MatteKind::Object), materials = all(MatteKind::Material);
  EXPECT_EQ(objects.at("cryptomatte/3ae39a5/name"), "CryptoObject");
  EXPECT_EQ(objects.at("cryptomatte/3ae39a5/hash"), "MurmurHash3_32");
  EXPECT_EQ(objects.at("cryptomatte/3ae39a5/conversion"), "uint32_to_float32");
  EXPECT_NE(objects.at("cryptomatte/3ae39a5/manifest").find("\"far\":\""), std::string::npos);
  EXPECT_EQ(materials.at("cryptomatte/be359d6/manifest").find("{\"a \\\"quoted\\\" one\":\""), 0u);
  EXPECT_NE(materials.at("cryptomatte/be359d6/manifest").find("\"material 1\":\""), std::string::npos);
}

TEST(Cryptomatte, SharesAddUpToTheCoverage) {
  const Scene scene = load_scene("teapot:divisions=6");
  const Camera camera = fit_camera(scene.bounds(), 1, {});
  const Frame frame = render(PreparedScene(scene), camera,
                             {.samples = standard_pattern(8), .planes = {.coverage = true, .sample_triangles = true}},
                             {.width = 90, .height = 90});
  for (const MatteKind kind : {MatteKind::Object, MatteKind::Material}) {
    const Cryptomatte matte = make_cryptomatte(frame, scene, kind);
    for (std::size_t i = 0; i < frame.coverage.values().size(); ++i) {
      float sum = 0;
      for (const auto& plane : matte.ranks) sum += plane.values()[i].y + plane.values()[i].w;
      ASSERT_EQ(sum, frame.coverage.values()[i]);
    }
  }
}

}  // namespace
}  // namespace zoneplate
