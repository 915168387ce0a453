// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/mtl_material.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/obj/obj.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

class MtlScene : public testing::Test {
 protected:
  MtlScene() : folder_(fs::temp_directory_path() / ("zoneplate_mtl_" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "model" / "sub dir");
  }
  ~MtlScene() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  /// Writes a 2 × 1 image of the given texels.
  void write_png(const std::string& name, Rgba8 left, Rgba8 right) const {
    Rgba8Image image(2, 1);
    image(0, 0) = left, image(1, 0) = right;
    const std::vector<std::uint8_t> bytes = encode_png(image);
    write(name, std::string(bytes.begin(), bytes.end()));
  }
  /// Loads a scene of one triangle with the material `m` of the given library.
  Scene load(const std::string& mtl, const LoadLimits& limits = {}) const {
    write("model/m.mtl", mtl);
    write("model/m.obj", "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    return load_obj((folder_ / "model/m.obj").string(), limits);
  }
  std::string warnings_of(const Scene& scene) const {
    std::string all;
    for (std::string text : scene.warnings) {
      const std::string prefix = folder_.string() + "/model/";
      for (std::size_t at = text.find(prefix); at != text.npos; at = text.find(prefix)) text.erase(at, prefix.size());
      all += text + "\n";
    }
    return all;
  }

  fs::path folder_;
};

// 3ds Max and MeshLab write Tr 1 of opaque materials.
TEST_F(MtlScene, AMaterialThatWouldHideItsSurfacesIsOpaque) {
  for (const std::string text : {"Tr 1.0\n", "d 0\n", "d 0\nTr 0.5\n"}) {
    const Scene scene = load("newmtl m\nKd .8 .2 .2\n" + text);
    EXPECT_EQ(scene.materials.at(0).base_color.w, 1) << text;
    EXPECT_EQ(scene.materials.at(0).alpha_mode, AlphaMode::Opaque) << text;
    EXPECT_EQ(warnings_of(scene), std::string("m.obj: material m: ") + (text[0] == 'T' ? "Tr 1" : "opacity 0") +
                                      " would hide its surfaces, taken as opaque\n");
  }
  EXPECT_EQ(load("newmtl m\nTr 0.75\n").materials.at(0).base_color.w, 0.25f);
  EXPECT_EQ(load("newmtl m\nd 1\nTr 1\n").materials.at(0).base_color.w, 1);
}

// MeshLab writes illum 2, Ks 1 and Ns 0 of every material.
TEST_F(MtlScene, WithoutAnExponentThereIsNoHighlight) {
  EXPECT_EQ(load("newmtl m\nKs 1 1 1\nNs 0\nillum 2\n").materials.at(0).specular, (float3{0, 0, 0}));
  EXPECT_EQ(load("newmtl m\nKs 1 1 1\nillum 2\n").materials.at(0).specular, (float3{0, 0, 0}));
  EXPECT_EQ(load("newmtl m\nKs 1 1 1\nNs 0.5\nillum 2\n").materials.at(0).specular, (float3{1, 1, 1}));
}

TEST_F(MtlScene, ColoursAreCodes) {
  const Material m = load("newmtl m\nKd 0.5 1 0\nKa 0.5 0.25 1\nKs 0.2 0.2 0.2\nKe 20 0 0.5\nNs 50\n").materials.at(0);
  EXPECT_EQ(m.model, ShadingModel::BlinnPhong);
  EXPECT_EQ(m.base_color, (float4{decode_srgb(0.5f), 1, 0, 1}));
  EXPECT_EQ(m.ambient, (float3{decode_srgb(0.5f), decode_srgb(0.25f), 1}));
  EXPECT_EQ(m.specular.x, decode_srgb(0.2f));
  EXPECT_EQ(m.emissive, (float3{20, 0, decode_srgb(0.5f)}));
  EXPECT_EQ(m.exponent, 50);
  EXPECT_EQ(m.alpha_mode, AlphaMode::Opaque);
  EXPECT_TRUE(m.double_sided);
}

TEST_F(MtlScene, ModelsFollowTheKeys) {
  EXPECT_EQ(load("newmtl m\nillum 0\n").materials[0].model, ShadingModel::Unlit);
  EXPECT_EQ(load("newmtl m\nillum 1\nKs 1 1 1\n").materials[0].specular, (float3{0, 0, 0}));
  EXPECT_EQ(load("newmtl m\nNs 0\n").materials[0].exponent, 1);
  const Material pbr = load("newmtl m\nPr 0.25\nPm 1\n").materials[0];
  EXPECT_EQ(pbr.model, ShadingModel::MetallicRoughness);
  EXPECT_EQ(pbr.roughness, 0.25f);
  EXPECT_EQ(pbr.metallic, 1);
  for (const char* text : {"newmtl m\nd 0.25\n", "newmtl m\nTr 0.75\n", "newmtl m\nTr 0\nd 0.25\n"}) {
    const Material m = load(text).materials[0];
    EXPECT_EQ(m.base_color.w, 0.25f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::Blend);
  }
}

TEST_F(MtlScene, FindsImagesWithinTheFolder) {
  write_png("model/sub dir/a b.png", {1, 2, 3, 255}, {4, 5, 6, 255});
  write_png("model/100%25.png", {7, 8, 9, 255}, {4, 5, 6, 255});
  write_png("outside.png", {7, 7, 7, 255}, {7, 7, 7, 255});
  const auto first = [&](const std::string& file, const LoadLimits& limits = {}) {
    const Scene scene = load("newmtl m\nmap_Kd " + file + "\n", limits);
    return scene.images.empty() ? -1 : int{scene.images[0].pixels.as<Rgba8>()(0, 0).r};
  };
  EXPECT_EQ(first("sub dir\\a b.png"), 1);
  EXPECT_EQ(first("./sub dir/a b.png"), 1);
  EXPECT_EQ(first("100%25.png"), 7);                // a file name is not percent-decoded
  EXPECT_EQ(first("C:\\textures\\100%25.png"), 7);  // the last component, in the model's folder
  EXPECT_EQ(first("../outside.png"), -1);
  EXPECT_EQ(first((folder_ / "outside.png").string()), -1);
  EXPECT_EQ(first("../outside.png", {.allowed_paths = {"/"}}), 7);
  EXPECT_EQ(first((folder_ / "outside.png").string(), {.allowed_paths = {"/"}}), 7);
  fs::create_symlink(folder_ / "outside.png", folder_ / "model/link.png");
  EXPECT_EQ(first("link.png"), -1);
  EXPECT_EQ(first("."), -1);
}

TEST_F(MtlScene, HighlightsHaveMaps) {
  write_png("model/s.png", {255, 0, 0, 255}, {0, 0, 0, 255});
  const Material m = load("newmtl m\nKs 0 0 0\nNs 64\nmap_Ks s.png\nmap_Ns s.png\n").materials.at(0);
  EXPECT_EQ(m.specular, (float3{1, 1, 1}));  // black over an image counts as white
  EXPECT_EQ(m.specular_texture.image, 0);
  EXPECT_EQ(m.exponent_texture.image, 0);
  EXPECT_EQ(load("newmtl m\nillum 1\nmap_Ks s.png\n").materials.at(0).specular_texture.image, -1);
}

TEST_F(MtlScene, MetallicRoughnessMaterialsHaveMapsAndLayers) {
  write_png("model/r.png", {10, 0, 0, 255}, {20, 0, 0, 255});
  write_png("model/m.png", {30, 0, 0, 255}, {40, 0, 0, 255});
  const Scene scene = load(
      "newmtl m\nmap_Pr -s 2 2 r.png\nmap_Pm m.png\nPc 0.5\nPcr 0.25\nPs 0.75\naniso 0.5\n"
      "anisor 0.25\nNi 1.25\n");
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.model, ShadingModel::MetallicRoughness);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.metallic, 1);
  const TexelImage& both = scene.images.at(static_cast<std::size_t>(m.metallic_roughness_texture.image)).pixels;
  EXPECT_EQ(both.as<Rgba8>()(1, 0), (Rgba8{255, 20, 40, 255}));
  EXPECT_EQ(m.metallic_roughness_texture.scale, (float2{2, 2}));
  ASSERT_NE(m.layers, nullptr);
  EXPECT_EQ(m.layers->clearcoat, 0.5f);
  EXPECT_EQ(m.layers->clearcoat_roughness, 0.25f);
  EXPECT_EQ(m.layers->sheen_color, (float3{0.75f, 0.75f, 0.75f}));
  EXPECT_EQ(m.layers->anisotropy, 0.5f);
  EXPECT_NEAR(m.layers->anisotropy_rotation, 1.5707963f, 1e-6f);
  EXPECT_EQ(m.layers->ior, 1.25f);
  EXPECT_EQ(load("newmtl m\nPr 0.5\n").materials.at(0).layers, nullptr);
}

TEST_F(MtlScene, BumpMapsAreHeightsOrNormals) {
  write_png("model/h.png", {10, 10, 10, 255}, {200, 200, 200, 255});
  write_png("model/n.png", {128, 128, 255, 255}, {188, 128, 240, 255});
  const std::string square =
      "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\nf 1/1 2/2 3/3 4/4\n";
  const auto material = [&](const std::string& keys) {
    write("model/m.mtl", "newmtl m\n" + keys), write("model/m.obj", square);
    const Scene scene = load_obj((folder_ / "model/m.obj").string());
    EXPECT_EQ(warnings_of(scene), "");
    return scene.materials.at(0);
  };
  // Two repetitions along 3 metres: a texture is 1.5 m wide, and 1 % of it is the unit of heights.
  const Material bumps = material("map_bump -bm 2 h.png\n");
  EXPECT_EQ(bumps.height_texture.image, 0);
  EXPECT_NEAR(bumps.height_scale, 2 * 0.015f, 1e-7f);
  EXPECT_EQ(bumps.normal_texture.image, -1);
  EXPECT_NEAR(material("bump -s 5 5 h.png\n").height_scale, 0.003f, 1e-8f);
  EXPECT_NEAR(material("disp h.png\n").height_scale, 0.015f, 1e-7f);
  const Material normals = material("map_bump -bm 0.5 n.png\n");
  EXPECT_EQ(normals.normal_texture.image, 0);
  EXPECT_EQ(normals.normal_scale, 0.5f);
  EXPECT_EQ(normals.height_texture.image, -1);
  const Material both = material("norm -bm 0.25 n.png\nmap_bump h.png\n");
  EXPECT_EQ(both.normal_scale, 0.25f);
  EXPECT_EQ(both.height_texture.image, 1);
  EXPECT_EQ(load("newmtl m\nbump h.png\n").materials.at(0).height_scale, 0);  // without texture coordinates
}

TEST_F(MtlScene, WarnsOfWhatIsMissing) {
  write("model/bad.png", "no image");
  const Scene scene =
      load("newmtl m\nmap_Kd gone.png\nmap_Ke bad.png\nrefl b.png\nnewmtl unused\nmap_Kd never-looked-for.png\n");
  EXPECT_EQ(scene.materials.at(0).base_color_texture.image, -1);
  EXPECT_EQ(scene.materials[0].base_color.x, 0.8f);
  EXPECT_EQ(warnings_of(scene),
            "m.obj: texture gone.png: not found in the model's folder\n"
            "m.obj: texture bad.png: is no known image, expected PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, HDR, EXR, "
            "PFM, KTX2, BMP or TGA\n"
            "m.obj: material m: not drawn: refl\n");
  write("model/m.obj", "mtllib a.mtl b c.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("model/b c.mtl", "");
  EXPECT_EQ(warnings_of(load_obj((folder_ / "model/m.obj").string())),
            "m.obj: material library a.mtl: not found in the model's folder\n"
            "m.obj: material library b: not found in the model's folder\n"
            "m.obj: material library c.mtl: not found in the model's folder\n");
  write("model/m.obj", "mtllib b c.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(warnings_of(load_obj((folder_ / "model/m.obj").string())), "");
}

// Blender finds such files too.
TEST_F(MtlScene, NamesInAnotherCaseAreFound) {
  write("model/C.mtl", "newmtl m\nmap_Kd TEX\\q.png\nmap_Ke r.PNG\n");
  write("model/m.obj", "mtllib c.MTL\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  fs::create_directories(folder_ / "model/Tex");
  write_png("model/Tex/Q.PNG", {1, 2, 3, 255}, {1, 2, 3, 255});
  write_png("model/R.png", {4, 5, 6, 255}, {4, 5, 6, 255});
  write_png("model/r.png", {7, 8, 9, 255}, {7, 8, 9, 255});
  const Scene scene = load_obj((folder_ / "model/m.obj").string());
  EXPECT_EQ(warnings_of(scene), "");
  ASSERT_EQ(scene.images.size(), 2u);
  // Of several names the first in the order of bytes counts.
  const auto texel = [&](int image) { return scene.images[static_cast<std::size_t>(image)].pixels.as<Rgba8>()(0, 0); };
  EXPECT_EQ(texel(scene.materials.at(0).base_color_texture.image), (Rgba8{1, 2, 3, 255}));
  EXPECT_EQ(texel(scene.materials.at(0).emissive_texture.image), (Rgba8{4, 5, 6, 255}));
  // The very name comes first, also where it is searched last.
  write_png("model/q.png", {9, 9, 9, 255}, {9, 9, 9, 255});
  const Scene exact = load_obj((folder_ / "model/m.obj").string());
  EXPECT_EQ(exact.images.at(0).pixels.as<Rgba8>()(0, 0), (Rgba8{9, 9, 9, 255}));
}

TEST_F(MtlScene, HintsAtFilesOutsideAndAtTiles) {
  fs::create_directories(folder_ / "textures");
  write_png("textures/x.png", {1, 2, 3, 255}, {1, 2, 3, 255});
  const std::string mtl = "newmtl m\nmap_Kd ../textures/x.png\nmap_Ke wall.<UDIM>.png\n";
  EXPECT_EQ(warnings_of(load(mtl)),
            "m.obj: texture ../textures/x.png: leads out of the model's folder (--allow-path PATH permits more)\n"
            "m.obj: texture wall.<UDIM>.png: a set of UDIM tiles, which are not drawn\n");
  EXPECT_EQ(load(mtl, {.allowed_paths = {(folder_ / "textures").string()}}).images.size(), 1u);
  write("model/m.obj", "mtllib ../m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  fs::remove(folder_ / "model/m.mtl");
  EXPECT_EQ(warnings_of(load_obj((folder_ / "model/m.obj").string())),
            "m.obj: material library ../m.mtl: leads out of the model's folder (--allow-path PATH permits more)\n");
}

TEST_F(MtlScene, KeepsWhatIsLeftOfADamagedJpeg) {
  const std::vector<std::uint8_t> bytes = encode_jpeg(Rgba8Image(8, 8, {200, 10, 10, 255}));
  write("model/cut.jpg", std::string(bytes.begin(), bytes.end() - 2));
  const Scene scene = load("newmtl m\nmap_Kd cut.jpg\n");
  EXPECT_EQ(warnings_of(scene), "m.obj: texture cut.jpg: JPEG: Premature end of JPEG file\n");
  ASSERT_EQ(scene.materials.at(0).base_color_texture.image, 0);
  EXPECT_NEAR(scene.images.at(0).pixels.as<Rgba8>()(4, 4).r, 200, 3);
  EXPECT_THROW(load("newmtl m\nmap_Kd cut.jpg\n", {.is_strict = true}), Error);
}

TEST_F(MtlScene, ReadsBitmaps) {
  const std::string bmp("BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x1\0\0\0\x1\0\0\0\x1\0\x18\0", 30);
  write("model/a.bmp", bmp + std::string(24, '\0') + "\x1\x2\x3");
  write("model/b.tga", std::string("\0\0\x3\0\0\0\0\0\0\0\0\0\x1\0\x1\0\x8\0\x7", 19));
  const Scene scene = load("newmtl m\nmap_Kd a.bmp\nmap_Ke b.tga\n");
  EXPECT_EQ(warnings_of(scene), "");
  ASSERT_EQ(scene.images.size(), 2u);
  EXPECT_EQ(scene.images[0].pixels.as<Rgba8>()(0, 0), (Rgba8{3, 2, 1, 255}));
  EXPECT_EQ(scene.images[1].pixels.as<Rgba8>()(0, 0), (Rgba8{7, 7, 7, 255}));
}

TEST_F(MtlScene, ImagesAreSharedScaledAndClamped) {
  write_png("model/a.png", {1, 2, 3, 255}, {4, 5, 6, 255});
  const Scene scene = load("newmtl m\nmap_Kd -s 2 3 -o 0.25 0.5 -clamp on a.png\nKd 0 0 0\nmap_Ke a.png\n");
  EXPECT_EQ(scene.images.size(), 1u);
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.base_color, (float4{1, 1, 1, 1}));
  EXPECT_EQ(m.emissive, (float3{1, 1, 1}));
  EXPECT_EQ(warnings_of(scene), "m.obj: material m: Kd is black over an image, taken as white\n");
  const TextureUse& use = m.base_color_texture;
  EXPECT_EQ(use.sampler.wrap_u, Wrap::Clamp);
  // The file's (0.5, 1) is mapped to (0.25 + 2 × 0.5, 0.5 + 3 × 1), whose v from the top is 1 - 3.5.
  EXPECT_EQ(use.offset.x + use.scale.x * 0.5f, 1.25f);
  EXPECT_EQ(use.offset.y + use.scale.y * (1 - 1), 1 - 3.5f);
}

// MTL has no rotation; materials of other formats have. The C library's sine has other bits than ours for some angles.
TEST_F(MtlScene, RotatesImagesByTheSameBitsEverywhere) {
  write_png("model/a.png", {1, 2, 3, 255}, {4, 5, 6, 255});
  ImportBudget budget("a.fbx", {});
  Scene scene;
  ModelFolder folder((folder_ / "model").string(), budget, scene);
  for (int i = -200; i <= 200; ++i) {
    const float angle = static_cast<float>(i) * 0.031f;
    const Material m = make_material({.diffuse_map = {.file = "a.png", .rotation = angle}}, "", folder);
    EXPECT_EQ(m.base_color_texture.offset, (float2{-sin(angle), 1 - cos(angle)})) << angle;
    if (i == 0) {
      EXPECT_EQ(m.base_color_texture.offset, (float2{0, 0}));
    }
  }
}

TEST_F(MtlScene, AmbientIsKdWhereThereIsNoKa) {
  const Material m = load("newmtl m\nKd 0.5 0 1\n").materials.at(0);
  EXPECT_EQ(m.ambient, (float3{decode_srgb(0.5f), 0, 1}));
  EXPECT_EQ(plain_material("").ambient, (float3{0.8f, 0.8f, 0.8f}));
  EXPECT_EQ(load("newmtl m\nKd 0 0 0\nKa 0.5 1 0\n").materials.at(0).ambient, (float3{decode_srgb(0.5f), 1, 0}));
}

TEST_F(MtlScene, ImagesKeepTheirBitsAndTheirLight) {
  Rgba16Image deep(2, 1);
  deep(0, 0) = {1, 2, 3, 65535}, deep(1, 0) = {65535, 258, 0, 65535};
  const auto text = [](const std::vector<std::uint8_t>& bytes) { return std::string(bytes.begin(), bytes.end()); };
  write("model/deep.png", text(encode_png(deep)));
  write("model/bright.hdr", std::string("#?RADIANCE\n\n-Y 1 +X 1\n\x80\x08") + '\0' + '\x96');
  const Scene scene = load("newmtl m\nmap_Kd deep.png\nmap_Ke bright.hdr\n");
  EXPECT_EQ(warnings_of(scene), "");
  ASSERT_EQ(scene.images.size(), 2u);
  EXPECT_EQ(scene.images[0].pixels, deep);
  EXPECT_EQ(scene.images[1].pixels, Plane<float4>(1, 1, float4{0x1p21f, 0x1p17f, 0, 1}));
  EXPECT_THROW(load("newmtl m\nmap_Ke bright.hdr\n", {.memory = 600}), Error);
}

TEST_F(MtlScene, ImagesThatAreTooWideAreNamed) {
  const std::vector<std::uint8_t> bytes = encode_png(Rgba8Image(100000, 1, {1, 2, 3, 255}));
  write("model/wide.png", std::string(bytes.begin(), bytes.end()));
  EXPECT_EQ(warnings_of(load("newmtl m\nmap_Kd wide.png\n")),
            "m.obj: texture wide.png: 100000 x 1 texels are drawn as 25000 x 1, at most 32768 a side\n");
}

TEST_F(MtlScene, OpacityMapsBecomeAlpha) {
  write_png("model/color.png", {1, 2, 3, 255}, {4, 5, 6, 255});
  write_png("model/mask.png", {255, 255, 255, 255}, {0, 0, 0, 255});
  write_png("model/alpha.png", {9, 9, 9, 200}, {9, 9, 9, 100});
  const auto texels = [](const Scene& scene) {
    const Material& m = scene.materials[0];
    const Rgba8Image& image = scene.images.at(static_cast<std::size_t>(m.base_color_texture.image)).pixels.as<Rgba8>();
    return std::vector<Rgba8>(image.values().begin(), image.values().end());
  };
  const Scene masked = load("newmtl m\nmap_Kd color.png\nmap_d mask.png\n");
  EXPECT_EQ(texels(masked), (std::vector<Rgba8>{{1, 2, 3, 255}, {4, 5, 6, 0}}));
  EXPECT_EQ(masked.materials[0].alpha_mode, AlphaMode::Blend);
  EXPECT_EQ(texels(load("newmtl m\nmap_d alpha.png\n")),
            (std::vector<Rgba8>{{255, 255, 255, 200}, {255, 255, 255, 100}}));
  // An image with alpha that is not referenced by a map_d is opaque.
  EXPECT_EQ(load("newmtl m\nmap_Kd alpha.png\n").materials[0].alpha_mode, AlphaMode::Opaque);
}

}  // namespace
}  // namespace zoneplate
