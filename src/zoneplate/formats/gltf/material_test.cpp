// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/material.h"
#include "zoneplate/scene/material_layers.h"

#include <gtest/gtest.h>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/load_for_test.h"

namespace zoneplate {
namespace {

std::vector<std::uint8_t> png(int width, int height, Rgba8 color) {
  return encode_png(Rgba8Image(width, height, color));
}

/// A triangle with the given materials; images 0 and 1 are a red and a green PNG, used by textures 0 and 1.
GltfMaker painted(const std::string& materials, const std::string& textures = "") {
  GltfMaker m = triangle_maker();
  const std::string red = m.view(png(2, 3, {255, 0, 0, 128})), green = m.view(png(1, 1, {0, 255, 0, 255}));
  m.materials = materials;
  m.rest = R"(,"images":[{"bufferView":)" + red + R"(,"mimeType":"image/png","name":"red"},{"bufferView":)" + green +
           R"(,"mimeType":"image/png"}],"textures":[)" +
           (textures.empty() ? R"({"source":0},{"source":1})" : textures) + "]";
  return m;
}

TEST(GltfMaterial, DefaultsAreTheSpecifications) {
  const Material m = load(painted("{}")).materials.at(0);
  EXPECT_EQ(m.base_color, (float4{1, 1, 1, 1}));
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.emissive, float3{});
  EXPECT_EQ(m.alpha_mode, AlphaMode::Opaque);
  EXPECT_EQ(m.alpha_cutoff, 0.5f);
  EXPECT_FALSE(m.double_sided);
  EXPECT_EQ(m.model, ShadingModel::MetallicRoughness);
  EXPECT_EQ(m.base_color_texture.image, -1);
}

TEST(GltfMaterial, EveryMember) {
  const Scene s = load(painted(R"({"name":"a","doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,
    "emissiveFactor":[0.5,0.25,1],"emissiveTexture":{"index":1},
    "normalTexture":{"index":0,"scale":-2},"occlusionTexture":{"index":1,"strength":0.75,"texCoord":1},
    "pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"baseColorTexture":{"index":1},
    "metallicFactor":0.125,"roughnessFactor":0.625,"metallicRoughnessTexture":{"index":0}},
    "extensions":{"KHR_materials_unlit":{},"KHR_materials_emissive_strength":{"emissiveStrength":4}}})"));
  const Material& m = s.materials.at(0);
  EXPECT_EQ(m.name, "a");
  EXPECT_TRUE(m.double_sided);
  EXPECT_EQ(m.alpha_mode, AlphaMode::Mask);
  EXPECT_EQ(m.alpha_cutoff, 0.25f);
  EXPECT_EQ(m.emissive, (float3{2, 1, 4}));
  EXPECT_EQ(m.base_color, (float4{0.1f, 0.2f, 0.3f, 0.4f}));
  EXPECT_EQ(m.metallic, 0.125f);
  EXPECT_EQ(m.roughness, 0.625f);
  EXPECT_EQ(m.normal_scale, -2);
  EXPECT_EQ(m.occlusion_strength, 0.75f);
  EXPECT_EQ(m.occlusion_texture.uv_set, 1);
  EXPECT_EQ(m.model, ShadingModel::Unlit);
  // Images are numbered in the order of their use: base colour, metallic-roughness, emissive, normal, occlusion.
  EXPECT_EQ(m.base_color_texture.image, 0);
  EXPECT_EQ(m.metallic_roughness_texture.image, 1);
  EXPECT_EQ(m.emissive_texture.image, 0);
  EXPECT_EQ(m.normal_texture.image, 1);
  EXPECT_EQ(m.occlusion_texture.image, 0);
  ASSERT_EQ(s.images.size(), 2u);
  EXPECT_EQ(s.images[1].name, "red");
  EXPECT_EQ(s.images[1].pixels, Rgba8Image(2, 3, {255, 0, 0, 128}));
  EXPECT_EQ(s.images[0].pixels, Rgba8Image(1, 1, {0, 255, 0, 255}));
}

TEST(GltfMaterial, AlphaModes) {
  EXPECT_EQ(load(painted(R"({"alphaMode":"BLEND"})")).materials.at(0).alpha_mode, AlphaMode::Blend);
  EXPECT_EQ(load(painted(R"({"alphaMode":"OPAQUE"})")).materials.at(0).alpha_mode, AlphaMode::Opaque);
  EXPECT_EQ(error_of(painted(R"({"alphaMode":"blend"})")),
            "material 0: alphaMode is 'blend', expected OPAQUE, MASK or BLEND");
}

TEST(GltfMaterial, TextureTransformAndItsUvSet) {
  const TextureUse use =
      load(painted(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":0,"extensions":
    {"KHR_texture_transform":{"offset":[0.5,-1],"scale":[2,3],"rotation":0.25,"texCoord":1}}}}})"))
          .materials.at(0)
          .base_color_texture;
  EXPECT_EQ(use.offset, (float2{0.5f, -1}));
  EXPECT_EQ(use.scale, (float2{2, 3}));
  EXPECT_EQ(use.rotation, 0.25f);
  EXPECT_EQ(use.uv_set, 1);
}

TEST(GltfMaterial, Samplers) {
  const auto sampler = [](const std::string& json) {
    GltfMaker m = painted(R"({"emissiveTexture":{"index":0}})", R"({"source":0,"sampler":0})");
    m.rest += R"(,"samplers":[{)" + json + "}]";
    return load(m, {.is_strict = true}).materials.at(0).emissive_texture.sampler;
  };
  EXPECT_EQ(sampler(""), Sampler{});
  EXPECT_EQ(sampler(R"("wrapS":33071,"wrapT":33648)").wrap_u, Wrap::Clamp);
  EXPECT_EQ(sampler(R"("wrapS":33071,"wrapT":33648)").wrap_v, Wrap::Mirror);
  EXPECT_EQ(sampler(R"("wrapS":10497)").wrap_u, Wrap::Repeat);
  EXPECT_EQ(sampler(R"("magFilter":9728)").magnify, TexelFilter::Nearest);
  EXPECT_EQ(sampler(R"("magFilter":9729)").magnify, TexelFilter::Linear);
  const struct {
    int number;
    TexelFilter texel;
    LevelFilter level;
  } minify[] = {{9728, TexelFilter::Nearest, LevelFilter::None},    {9729, TexelFilter::Linear, LevelFilter::None},
                {9984, TexelFilter::Nearest, LevelFilter::Nearest}, {9985, TexelFilter::Linear, LevelFilter::Nearest},
                {9986, TexelFilter::Nearest, LevelFilter::Linear},  {9987, TexelFilter::Linear, LevelFilter::Linear}};
  for (const auto& wanted : minify) {
    const Sampler s = sampler(R"("minFilter":)" + std::to_string(wanted.number));
    EXPECT_EQ(s.minify, wanted.texel) << wanted.number;
    EXPECT_EQ(s.level, wanted.level) << wanted.number;
  }
  EXPECT_THROW(sampler(R"("minFilter":9983)"), Error);
  EXPECT_THROW(sampler(R"("magFilter":9984)"), Error);
  EXPECT_THROW(sampler(R"("wrapS":1)"), Error);
}

TEST(GltfMaterial, OutOfRangeIsClampedWithOneWarning) {
  const Scene s = load(painted(R"({"pbrMetallicRoughness":{"metallicFactor":2,"baseColorFactor":[-1,2,0,1]}})"));
  EXPECT_EQ(s.materials.at(0).metallic, 1);
  EXPECT_EQ(s.materials.at(0).base_color, (float4{0, 1, 0, 1}));
  EXPECT_EQ(s.warnings.size(), 2u);
}

TEST(GltfMaterial, UvSetsPastTheSecondAreLeftOut) {
  const Scene s = load(painted(R"({"emissiveTexture":{"index":0,"texCoord":2}})"));
  EXPECT_EQ(s.materials.at(0).emissive_texture.image, -1);
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_NE(s.warnings[0].find("material 0 emissiveTexture: uses TEXCOORD_2"), std::string::npos);
}

TEST(GltfMaterial, TexturesWithoutASupportedImageAreLeftOut) {
  const Scene s = load(painted(R"({"emissiveTexture":{"index":0}})", R"({"extensions":{"EXT_texture_webp":{}}})"));
  EXPECT_EQ(s.materials.at(0).emissive_texture.image, -1);
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_NE(s.warnings[0].find("texture 0: has no image that is supported"), std::string::npos);
}

TEST(GltfMaterial, BasisTexturesReplaceTheirFallback) {
  const Scene s = load(painted(R"({"emissiveTexture":{"index":0}})",
                               R"({"source":0,"extensions":{"KHR_texture_basisu":{"source":1}}})"));
  ASSERT_EQ(s.materials.at(0).emissive_texture.image, 0);
  EXPECT_EQ(s.images.at(0).pixels.as<Rgba8>()(0, 0).g, 255);
  EXPECT_TRUE(s.warnings.empty());
}

TEST(GltfMaterial, IndicesMustBeInRange) {
  EXPECT_EQ(error_of(painted(R"({"emissiveTexture":{"index":2}})")),
            "material 0 emissiveTexture: index is 2, expected an index below 2");
  EXPECT_EQ(error_of(painted(R"({"emissiveTexture":{}})")), "material 0 emissiveTexture: index is missing");
  EXPECT_EQ(error_of(painted(R"({"emissiveTexture":{"index":0}})", R"({"source":2})")),
            "texture 0: source is 2, expected an index below 2");
  EXPECT_EQ(error_of(painted(R"({"emissiveTexture":{"index":0}})", R"({"source":0,"sampler":0})")),
            "texture 0: sampler is 0, expected an index below 0");
  EXPECT_EQ(error_of(painted(R"({"emissiveFactor":[1,1]})")), "material 0: emissiveFactor holds 2 numbers, expected 3");
}

TEST(GltfMaterial, ImagesThatNobodyUsesAreNotRead) {
  GltfMaker m = painted(R"({"emissiveTexture":{"index":0}})");
  m.rest = R"(,"images":[{"uri":"none.png"},{"bufferView":1}],"textures":[{"source":1},{"source":0}])";
  EXPECT_EQ(load(m).images.size(), 1u);
}

TEST(GltfMaterial, ImageErrorsNameTheFirstImage) {
  const LoadLimits strict{.is_strict = true};
  GltfMaker m = painted(R"({"emissiveTexture":{"index":0},"occlusionTexture":{"index":1}})");
  m.rest = R"(,"images":[{"bufferView":0,"name":"x"},{"bufferView":0}],"textures":[{"source":0},{"source":1}])";
  EXPECT_EQ(error_of(m, strict),
            "image 0 'x': is no known image, expected PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, PFM, KTX2, "
            "BMP or TGA");
  m.rest = R"(,"images":[{"uri":"none.png"},{}],"textures":[{"source":0},{"source":1}])";
  EXPECT_EQ(error_of(m, strict).rfind("image 0: ", 0), 0u);
  m.rest = R"(,"images":[{"bufferView":1},{}],"textures":[{"source":0},{"source":1}])";
  EXPECT_EQ(error_of(m, strict), "image 1: has neither uri nor bufferView");
}

// The material keeps its factors and its other textures.
TEST(GltfMaterial, IsDrawnWithoutImagesThatCannotBeRead) {
  GltfMaker m =
      painted(R"({"emissiveTexture":{"index":0},"normalTexture":{"index":1},"emissiveFactor":[1,0.5,0],)"
              R"("extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatTexture":{"index":0}}}})");
  m.rest = R"(,"images":[{"uri":"none.png"},{"bufferView":1}],"textures":[{"source":0},{"source":1}])";
  const Scene s = load(m);
  ASSERT_EQ(s.images.size(), 1u);
  const Material& material = s.materials.at(0);
  EXPECT_EQ(material.emissive_texture.image, -1);
  EXPECT_EQ(material.emissive.y, 0.5f);
  EXPECT_EQ(material.normal_texture.image, 0);
  EXPECT_EQ(material.layers->clearcoat_texture.image, -1);
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_NE(s.warnings[0].find("image 0: "), std::string::npos) << s.warnings[0];
  EXPECT_TRUE(s.warnings[0].ends_with("; drawn without it")) << s.warnings[0];
}

TEST(GltfMaterial, EmbeddedImagesKeepTheirBitsAndTheirLight) {
  const float light[] = {1e4f, 2e5f, 0.25f};
  const auto exr = encode_exr(1, 1,
                              {{"R", ExrType::Float, light, nullptr, 1},
                               {"G", ExrType::Float, light + 1, nullptr, 1},
                               {"B", ExrType::Float, light + 2, nullptr, 1}});
  const Rgba16Image deep(2, 1, {1, 20000, 20001, 65535});
  GltfMaker m = triangle_maker();
  const std::string bright = m.view(exr), data = m.view(encode_png(deep));
  m.materials = R"({"emissiveTexture":{"index":0},"normalTexture":{"index":1}})";
  m.rest = R"(,"images":[{"bufferView":)" + bright + R"(},{"bufferView":)" + data +
           R"(}],"textures":[{"source":0},{"source":1}])";
  const Scene s = load(m);
  ASSERT_EQ(s.images.size(), 2u);
  EXPECT_EQ(s.images[0].pixels, Plane<float4>(1, 1, float4{1e4f, 2e5f, 0.25f, 1}));
  EXPECT_EQ(s.images[1].pixels, deep);
}

TEST(GltfMaterial, ImagesThatAreTooWideAreNamed) {
  GltfMaker m = triangle_maker();
  m.rest =
      R"(,"images":[{"name":"strip","bufferView":)" + m.view(png(40000, 1, {})) + R"(}],"textures":[{"source":0}])";
  m.materials = R"({"emissiveTexture":{"index":0}})";
  const Scene s = load(m);
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_NE(s.warnings[0].find("f.glb: texture strip: 40000 x 1 texels are drawn as 20000 x 1"), std::string::npos);
}

TEST(GltfMaterial, PixelsAreLimited) {
  const GltfMaker m = painted(R"({"emissiveTexture":{"index":0}})");
  EXPECT_EQ(error_of(m, {.pixels = 5, .is_strict = true}), "image 0: has 2 x 3 pixels, the limit is 5 (--max-pixels)");
  EXPECT_EQ(error_of(m, {.pixels = 6, .is_strict = true}), "no error");
  GltfMaker wide = triangle_maker();
  std::vector<std::uint8_t> bomb = png(1, 1, {});
  bomb[16] = bomb[20] = 0x7f;  // width and height of the header
  wide.rest = R"(,"images":[{"bufferView":)" + wide.view(bomb) + R"(}],"textures":[{"source":0}])";
  wide.materials = R"({"emissiveTexture":{"index":0}})";
  EXPECT_NE(error_of(wide, {.is_strict = true}).find("--max-pixels"), std::string::npos);
  EXPECT_NE(error_of(wide, {.pixels = ~std::uint64_t{0}}).find("--max-memory"), std::string::npos);
}

}  // namespace
}  // namespace zoneplate
