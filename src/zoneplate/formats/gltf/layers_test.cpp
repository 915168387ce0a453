// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/layers.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/load_for_test.h"

namespace zoneplate {
namespace {

/// A triangle whose material has these extensions; texture 0 is an image.
GltfMaker layered(const std::string& extensions, const std::string& more = "") {
  GltfMaker m = triangle_maker();
  const std::string image = m.view(encode_png(Rgba8Image(1, 1, {1, 2, 3, 4})));
  m.materials = R"({"extensions":{)" + extensions + "}" + more + "}";
  m.rest = R"(,"textures":[{"source":0}],"images":[{"bufferView":)" + image + R"(,"mimeType":"image/png"}])";
  return m;
}

Material material_of(const std::string& extensions, const std::string& more = "") {
  return load(layered(extensions, more)).materials.at(0);
}

MaterialLayers layers_of(const std::string& extensions) {
  const Material m = material_of(extensions);
  EXPECT_NE(m.layers, nullptr);
  return m.layers != nullptr ? *m.layers : MaterialLayers();
}

TEST(GltfLayers, AreAbsentWithoutTheirExtensions) {
  EXPECT_EQ(material_of("").layers, nullptr);
  EXPECT_EQ(material_of(R"("KHR_materials_emissive_strength":{})").layers, nullptr);
  EXPECT_EQ(material_of(R"("KHR_materials_clearcoat":{"clearcoatFactor":1},"KHR_materials_unlit":{})").layers, nullptr);
}

TEST(GltfLayers, DefaultsAreTheSpecifications) {
  const MaterialLayers m = layers_of(
      R"("KHR_materials_ior":{},"KHR_materials_specular":{},"KHR_materials_clearcoat":{},"KHR_materials_sheen":{},
      "KHR_materials_anisotropy":{},"KHR_materials_iridescence":{},"KHR_materials_transmission":{},
      "KHR_materials_volume":{},"KHR_materials_dispersion":{},"KHR_materials_diffuse_transmission":{})");
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.specular, 1);
  EXPECT_EQ(m.specular_color, (float3{1, 1, 1}));
  EXPECT_FALSE(m.glossiness);
  EXPECT_EQ(m.clearcoat, 0);
  EXPECT_EQ(m.clearcoat_normal_scale, 1);
  EXPECT_EQ(m.sheen_color, float3{});
  EXPECT_EQ(m.anisotropy, 0);
  EXPECT_EQ(m.iridescence, 0);
  EXPECT_EQ(m.iridescence_ior, 1.3f);
  EXPECT_EQ(m.iridescence_thickness_minimum, 100);
  EXPECT_EQ(m.iridescence_thickness_maximum, 400);
  EXPECT_EQ(m.transmission, 0);
  EXPECT_EQ(m.thickness, 0);
  EXPECT_EQ(m.attenuation_distance, std::numeric_limits<float>::infinity());
  EXPECT_EQ(m.attenuation_color, (float3{1, 1, 1}));
  EXPECT_EQ(m.dispersion, 0);
  EXPECT_EQ(m.diffuse_transmission, 0);
  EXPECT_EQ(m.diffuse_transmission_color, (float3{1, 1, 1}));
}

TEST(GltfLayers, EveryFactor) {
  const MaterialLayers m = layers_of(
      R"("KHR_materials_ior":{"ior":1.25},"KHR_materials_specular":{"specularFactor":0.25,"specularColorFactor":[1,2,3]},
      "KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatRoughnessFactor":0.125,
        "clearcoatNormalTexture":{"index":0,"scale":-2}},
      "KHR_materials_sheen":{"sheenColorFactor":[0.5,0.25,1],"sheenRoughnessFactor":0.75},
      "KHR_materials_anisotropy":{"anisotropyStrength":0.625,"anisotropyRotation":-4},
      "KHR_materials_iridescence":{"iridescenceFactor":0.5,"iridescenceIor":1.75,"iridescenceThicknessMinimum":500,
        "iridescenceThicknessMaximum":200},
      "KHR_materials_transmission":{"transmissionFactor":0.875},
      "KHR_materials_volume":{"thicknessFactor":7,"attenuationDistance":0.5,"attenuationColor":[0.5,0,1]},
      "KHR_materials_dispersion":{"dispersion":2.5},
      "KHR_materials_diffuse_transmission":{"diffuseTransmissionFactor":0.375,
        "diffuseTransmissionColorFactor":[0,0.5,1]})");
  EXPECT_EQ(m.ior, 1.25f);
  EXPECT_EQ(m.specular, 0.25f);
  EXPECT_EQ(m.specular_color, (float3{1, 2, 3}));
  EXPECT_EQ(m.clearcoat, 0.5f);
  EXPECT_EQ(m.clearcoat_roughness, 0.125f);
  EXPECT_EQ(m.clearcoat_normal_scale, -2);
  EXPECT_EQ(m.sheen_color, (float3{0.5f, 0.25f, 1}));
  EXPECT_EQ(m.sheen_roughness, 0.75f);
  EXPECT_EQ(m.anisotropy, 0.625f);
  EXPECT_EQ(m.anisotropy_rotation, -4);
  EXPECT_EQ(m.iridescence, 0.5f);
  EXPECT_EQ(m.iridescence_ior, 1.75f);
  EXPECT_EQ(m.iridescence_thickness_minimum, 500);
  EXPECT_EQ(m.iridescence_thickness_maximum, 200);
  EXPECT_EQ(m.transmission, 0.875f);
  EXPECT_EQ(m.thickness, 7);
  EXPECT_EQ(m.attenuation_distance, 0.5f);
  EXPECT_EQ(m.attenuation_color, (float3{0.5f, 0, 1}));
  EXPECT_EQ(m.dispersion, 2.5f);
  EXPECT_EQ(m.diffuse_transmission, 0.375f);
  EXPECT_EQ(m.diffuse_transmission_color, (float3{0, 0.5f, 1}));
}

TEST(GltfLayers, EveryTexture) {
  for (const LayerTextureSlot& slot : layer_texture_slots) {
    const Material m = material_of("\"" + std::string(slot.extension) + R"(":{")" + std::string(slot.gltf_name) +
                                   R"(":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[0.5,0.25]}}}})");
    ASSERT_NE(m.layers, nullptr) << slot.gltf_name;
    for (const LayerTextureSlot& other : layer_texture_slots)
      EXPECT_EQ(((*m.layers).*other.use).image, &other == &slot ? 0 : -1) << slot.gltf_name << " " << other.gltf_name;
    EXPECT_EQ(((*m.layers).*slot.use).offset, (float2{0.5f, 0.25f})) << slot.gltf_name;
  }
}

TEST(GltfLayers, FactorsOutOfRangeAreClamped) {
  const Scene s = load(layered(R"("KHR_materials_ior":{"ior":0.5},"KHR_materials_clearcoat":{"clearcoatFactor":2},
      "KHR_materials_volume":{"thicknessFactor":-1,"attenuationDistance":0})"));
  const MaterialLayers& m = *s.materials.at(0).layers;
  EXPECT_EQ(m.ior, 1);
  EXPECT_EQ(m.clearcoat, 1);
  EXPECT_EQ(m.thickness, 0);
  EXPECT_GT(m.attenuation_distance, 0);
  EXPECT_EQ(s.warnings.size(), 4u);
  EXPECT_EQ(layers_of(R"("KHR_materials_ior":{"ior":0})").ior, 0);  // a mode of its own
}

TEST(GltfLayers, SpecularGlossinessIsADielectricOfInfiniteIndex) {
  const Material m = material_of(
      R"("KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[0.5,0.25,0.125,0.75],"diffuseTexture":{"index":0},
      "specularFactor":[0.1,0.2,0.3],"glossinessFactor":0.75,"specularGlossinessTexture":{"index":0}})",
      R"(,"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"metallicRoughnessTexture":{"index":0}})");
  EXPECT_EQ(m.base_color, (float4{0.5f, 0.25f, 0.125f, 0.75f}));
  EXPECT_EQ(m.base_color_texture.image, 0);
  EXPECT_EQ(m.metallic, 0);
  EXPECT_EQ(m.metallic_roughness_texture.image, -1);
  EXPECT_EQ(m.layers->ior, 0);
  EXPECT_EQ(m.layers->specular_color, (float3{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(m.layers->specular_color_texture.image, 0);
  EXPECT_EQ(m.layers->glossiness, 0.75f);
}

TEST(GltfLayers, TangentsComeWithTheirTextures) {
  // The triangle has no tangents: they are made from its texture coordinates where a layer needs them.
  GltfMaker m = layered(R"("KHR_materials_anisotropy":{"anisotropyStrength":1})");
  m.meshes.clear();
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}) + R"(,"NORMAL":)" +
             m.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1}) + R"(,"TEXCOORD_0":)" + m.floats("VEC2", {0, 0, 1, 0, 0, 1}),
         R"(,"material":0)");
  EXPECT_EQ(load(m).meshes.at(0).tangent.size(), 3u);
}

}  // namespace
}  // namespace zoneplate
