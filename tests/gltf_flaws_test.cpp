// SPDX-License-Identifier: Apache-2.0
// A flaw in a part that the picture can do without: the part is left out with a warning that names it, the rest is
// drawn, and with strict limits the file is refused.
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/formats/gltf/load_for_test.h"

namespace zoneplate {
namespace {

const std::vector<float> triangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

/// Loads the flawed file: its only warning begins with `place`, and the strict error with it too. The scene has the
/// given number of meshes.
Scene load_flawed(const GltfMaker& m, const std::string& place, std::size_t meshes = 1) {
  Scene scene = load(m);
  EXPECT_EQ(scene.meshes.size(), meshes) << place;
  EXPECT_EQ(scene.warnings.size(), 1u) << place;
  const std::string warning = scene.warnings.empty() ? "none" : scene.warnings[0];
  EXPECT_NE(warning.find("f.glb: " + place), std::string::npos) << warning;
  const std::string strict = error_of(m);
  EXPECT_TRUE(strict.starts_with(place)) << strict;
  return scene;
}

GltfMaker with_rest(const std::string& rest) {
  GltfMaker m = triangle_maker();
  m.rest = rest;
  return m;
}
GltfMaker with_material(const std::string& material, const std::string& rest = "") {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", triangle), R"(,"material":0)");
  m.materials = material;
  m.rest = rest;
  return m;
}

TEST(GltfFlaws, OfCamerasAndLights) {
  GltfMaker m = with_rest(R"(,"cameras":[{"type":"fisheye"}])");
  m.nodes = R"({"mesh":0,"camera":0})";
  EXPECT_TRUE(load_flawed(m, "camera 0: type is").cameras.empty());
  m = with_rest(R"(,"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})");
  m.nodes = R"({"mesh":0,"extensions":{"KHR_lights_punctual":{"light":7}}})";
  EXPECT_TRUE(load_flawed(m, "node 0 KHR_lights_punctual: light is 7").lights.empty());
}

TEST(GltfFlaws, ANodeOfScaleZeroIsNotInTheBounds) {
  GltfMaker m = triangle_maker();
  m.nodes = R"({"mesh":0},{"mesh":0,"scale":[0,0,0],"translation":[50,0,0]})";
  m.scene_nodes = "0,1";
  const Scene scene = load(m);
  EXPECT_EQ(scene.bounds().high.x, 1);
  EXPECT_EQ(scene.objects.size(), 2u);
}

TEST(GltfFlaws, OfMaterials) {
  const std::string white = R"("pbrMetallicRoughness":{"baseColorFactor":[1,0,0]},"doubleSided":true)";
  EXPECT_TRUE(load_flawed(with_material("{" + white + "}"), "material 0 pbrMetallicRoughness: baseColorFactor")
                  .materials.at(0)
                  .double_sided);
  EXPECT_EQ(load_flawed(with_material(R"({"alphaMode":"blend","alphaCutoff":0.25})"), "material 0: alphaMode is")
                .materials.at(0)
                .alpha_cutoff,
            0.25f);
  EXPECT_EQ(load_flawed(with_material(R"({"emissiveTexture":{"index":9},"emissiveFactor":[1,1,1]})"),
                        "material 0 emissiveTexture: index is 9")
                .materials.at(0)
                .emissive,
            (float3{1, 1, 1}));
  load_flawed(with_material(R"({"extensions":{"KHR_materials_ior":{"ior":"glass"}}})"),
              "material 0 KHR_materials_ior: ior");
  GltfMaker lost = with_material("{}");
  lost.materials = "";
  EXPECT_EQ(load_flawed(lost, "mesh 0 primitive 0: material is 0, expected an index below 0").meshes.at(0).primitives(),
            1u);
  EXPECT_TRUE(load(with_material(R"({"extensions":null})")).warnings.empty());
  const Scene scene = load(with_material(R"({"extensions":{"KHR_materials_unlit":null}})"));
  EXPECT_EQ(scene.materials.at(0).model, ShadingModel::MetallicRoughness);
  EXPECT_TRUE(scene.warnings.empty());
}

// An image that cannot be decoded shifts the indices of those after it, also where an animation changes materials.
TEST(GltfFlaws, OfImagesOfAnimatedMaterials) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", triangle), R"(,"material":0)");
  m.materials = R"({"emissiveTexture":{"index":0},"emissiveFactor":[1,1,1]})";
  const std::string input = m.floats("SCALAR", {0, 1}), output = m.floats("VEC3", {0, 0, 0, 1, 1, 1});
  m.rest = R"(,"textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,iVBORw0KGgo="}],"animations":[)"
           R"({"channels":[{"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":)"
           R"({"pointer":"/materials/0/emissiveFactor"}}}}],"samplers":[{"input":)" +
           input + R"(,"output":)" + output + "}]}]";
  const TestFolder folder;
  const std::string path = folder.write("f.glb", m.glb());
  const Scene scene = load_gltf(path, {}, {.animation = 0, .time = 0.5});
  EXPECT_EQ(scene.materials.at(0).emissive_texture.image, -1);
  EXPECT_EQ(scene.materials.at(0).emissive.x, 0.5f);
}

TEST(GltfFlaws, OfAttributes) {
  const auto mesh_with = [](const std::string& key, const std::string& type, const std::vector<float>& values) {
    GltfMaker m;
    m.mesh(R"("POSITION":)" + m.floats("VEC3", triangle) + ",\"" + key + "\":" + m.floats(type, values));
    return m;
  };
  EXPECT_EQ(load_flawed(mesh_with("NORMAL", "VEC3", {0, 0, 1}), "mesh 0 primitive 0: NORMAL has 1 elements")
                .meshes[0]
                .normal.at(0),
            (float3{0, 0, 1}));
  EXPECT_TRUE(load_flawed(mesh_with("TEXCOORD_0", "VEC2", {0, 0, 1, 0}), "mesh 0 primitive 0: TEXCOORD_0 has 2")
                  .meshes[0]
                  .uv0.empty());
}

TEST(GltfFlaws, AttributesThatAreNotFiniteCostNoTriangle) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", triangle) + R"(,"NORMAL":)" +
         m.floats("VEC3", {NAN, 0, 0, 0, 0, 1, 0, 0, 1}) + R"(,"TEXCOORD_0":)" +
         m.floats("VEC2", {0, 0, INFINITY, 0, 0, 1}) + R"(,"COLOR_0":)" +
         m.floats("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, NAN, 0, 0, 1}));
  const Scene scene = load(m);
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_EQ(mesh.primitives(), 1u);
  EXPECT_EQ(mesh.normal[0], (float3{0, 0, 1}));
  EXPECT_EQ(mesh.uv0[1], float2{});
  EXPECT_EQ(mesh.color[2], (float4{1, 1, 1, 1}));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("attributes of 3 vertices are not finite and are replaced"), std::string::npos);
}

TEST(GltfFlaws, ColoursAreClamped) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", triangle) + R"(,"COLOR_0":)" +
         m.values<std::uint8_t>("VEC3", {255, 0, 0, 255, 0, 0, 255, 0, 0}));
  EXPECT_EQ(load(m).meshes.at(0).color.at(0), (float4{1, 0, 0, 1}));
}

TEST(GltfFlaws, OfOnePrimitive) {
  GltfMaker m;
  const std::string position = R"({"attributes":{"POSITION":)" + m.floats("VEC3", triangle) + "}";
  const std::string bad = R"(,"indices":)" + m.values<std::uint8_t>("SCALAR", {0, 1, 9});
  m.meshes = R"({"primitives":[)" + position + bad + "}," + position + "}]}";
  load_flawed(m, "mesh 0 primitive 0: index 2 is 9");
  m.meshes = R"({"primitives":[)" + position + bad + "}]}";
  EXPECT_THROW(load(m), Error);  // nothing is left to draw
}

TEST(GltfFlaws, OfMorphTargets) {
  GltfMaker m;
  m.meshes = R"({"weights":[1],"primitives":[{"attributes":{"POSITION":)" + m.floats("VEC3", triangle) +
             R"(},"targets":[{"POSITION":)" + m.floats("VEC3", {0, 0, 2}) + "}]}]}";
  load_flawed(m, "mesh 0 primitive 0 target 0: POSITION has 1 elements");
}

TEST(GltfFlaws, BufferViewsMayEndBehindTheirBuffer) {
  GltfMaker m = triangle_maker();
  m.views.replace(m.views.find(R"("byteLength":36)"), 15, R"("byteLength":40)");
  load_flawed(m, "bufferView 0: ends at byte 40 of a buffer of 36");
  m.views.replace(m.views.find(R"("byteLength":40)"), 15, R"("byteLength":32)");
  EXPECT_THROW(load(m), Error);
}

TEST(GltfFlaws, TheVersionMayBeANumber) {
  for (const auto& [version, is_read] : {std::pair("2.0", true), {"2", true}, {"1.0", false}, {"3", false}}) {
    const TestFolder folder;
    std::string json = triangle_maker().json();
    json.replace(json.find("\"2.0\""), 5, version);
    const std::string path = folder.write("f.glb", GltfMaker::glb(json, triangle_maker().binary));
    if (is_read) {
      EXPECT_EQ(load_gltf(path).warnings.size(), 1u) << version;
    } else {
      EXPECT_THROW(load_gltf(path), Error) << version;
    }
  }
}

// Blender writes times before 0, and several exporters a jump as two keys of one time.
TEST(GltfFlaws, TimesOfKeysMayBeNegativeOrEqual) {
  GltfMaker m = triangle_maker();
  const std::string input = m.floats("SCALAR", {-1, 1, 1, 2}),
                    output = m.floats("VEC3", {0, 0, 0, 2, 0, 0, 5, 0, 0, 6, 0, 0});
  m.rest = R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}},)"
           R"({"sampler":1,"target":{"node":0,"path":"scale"}}],"samplers":[{"input":)" +
           input + R"(,"output":)" + output + R"(},{"input":99,"output":0}]}])";
  const TestFolder folder;
  const std::string path = folder.write("f.glb", m.glb());
  const auto x_at = [&](double time) {
    const Scene scene = load_gltf(path, {}, {.animation = 0, .time = time});
    EXPECT_FALSE(scene.warnings.empty());  // of the second channel, which is left out
    return scene.instances.at(0).world_from_object.column[3].x;
  };
  EXPECT_EQ(x_at(-2), 0);
  EXPECT_EQ(x_at(0), 1);
  EXPECT_EQ(x_at(1), 5);
  EXPECT_EQ(x_at(1.5), 5.5f);
  EXPECT_EQ(x_at(3), 6);
}

}  // namespace
}  // namespace zoneplate
