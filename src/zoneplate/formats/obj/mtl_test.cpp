// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/mtl.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace zoneplate {
namespace {

struct Parsed {
  std::vector<MtlMaterial> materials;
  std::vector<std::string> warnings;
};
Parsed parsed_mtl(const std::string& text) {
  Parsed p;
  p.materials = parse_mtl(text, "a.mtl", p.warnings);
  return p;
}

TEST(ParseMtl, ReadsColoursAndValues) {
  const Parsed p = parsed_mtl(
      "# all keys\n\nnewmtl dark red #2\r\n\tKd 0.5 0 1\nka .25\nKs 1 1 1\nKe 20 0 0\nNs 96.5\nd 0.5\nTr 0.25\nillum "
      "1\n"
      "Pr 0.2\nPm 0.3\nNi 1.5\nTf 1 1 1\nnewmtl plain");
  ASSERT_EQ(p.materials.size(), 2u);
  const MtlMaterial& m = p.materials[0];
  EXPECT_EQ(m.name, "dark red #2");
  EXPECT_EQ(m.diffuse, (float3{0.5f, 0, 1}));
  EXPECT_EQ(m.ambient, (float3{0.25f, 0.25f, 0.25f}));
  EXPECT_EQ(m.emissive, (float3{20, 0, 0}));
  EXPECT_EQ(m.exponent, 96.5f);
  EXPECT_EQ(m.opacity, 0.5f);
  EXPECT_EQ(m.transparency, 0.25f);
  EXPECT_EQ(m.illumination, 1);
  EXPECT_EQ(m.roughness, 0.2f);
  EXPECT_EQ(m.metallic, 0.3f);
  EXPECT_FALSE(p.materials[1].diffuse.has_value());
  EXPECT_TRUE(p.warnings.empty());
}

TEST(ParseMtl, ReadsTheOptionsOfMaps) {
  const Parsed p = parsed_mtl(
      "newmtl a\nmap_Kd -s 2 3 1 -o 0.5 -clamp on -blendu off -mm 0 1 textures\\my brick 2.png\n"
      "map_d -imfchan m -bm 2 mask.png\nnorm -bm 0.5 n.png\nmap_Ke 7\nmap_Bump -bm 3 b.png\ndisp d.png\nrefl "
      "r.png\nmap_Pr r.png\nmap_Ka "
      "a.png\n");
  const MtlMaterial& m = p.materials.at(0);
  EXPECT_EQ(m.diffuse_map.file, "textures\\my brick 2.png");
  EXPECT_EQ(m.diffuse_map.scale, (float2{2, 3}));
  EXPECT_EQ(m.diffuse_map.offset, (float2{0.5f, 0}));
  EXPECT_TRUE(m.diffuse_map.clamp);
  EXPECT_EQ(m.opacity_map.file, "mask.png");
  EXPECT_EQ(m.normal_map.strength, 0.5f);
  EXPECT_EQ(m.emissive_map.file, "7");
  EXPECT_EQ(m.bump_map.file, "b.png");
  EXPECT_EQ(m.bump_map.strength, 3);
  EXPECT_EQ(m.displacement_map.file, "d.png");
  EXPECT_EQ(m.unsupported, (std::vector<std::string>{"refl"}));
  EXPECT_EQ(parsed_mtl("newmtl a\nmap_Kd -s 2 3 4\n").materials[0].diffuse_map.file, "4");
}

TEST(ParseMtl, ReadsOptionsAndCommentsBehindTheNameOfAMap) {
  const auto map_of = [](const std::string& line) {
    return parsed_mtl("newmtl a\nmap_Kd " + line + "\n").materials.at(0).diffuse_map;
  };
  EXPECT_EQ(map_of("q.png -bm 1").file, "q.png");
  const MtlTexture both = map_of("-o 0.5 my wood.png -s 2 3 -clamp on");
  EXPECT_EQ(both.file, "my wood.png");
  EXPECT_EQ(both.offset, (float2{0.5f, 0}));
  EXPECT_EQ(both.scale, (float2{2, 3}));
  EXPECT_TRUE(both.clamp);
  EXPECT_EQ(map_of("q.jpeg # of oak").file, "q.jpeg");
  EXPECT_EQ(map_of("wood #2.png").file, "wood #2.png");
  EXPECT_EQ(map_of("oak -s 2.png").file, "oak -s 2.png");
  EXPECT_EQ(map_of("a.b - c.png").file, "a.b - c.png");
}

TEST(ParseMtl, NamesAMapOfKaWithoutOneOfKd) {
  EXPECT_EQ(parsed_mtl("newmtl a\nmap_Ka a.png\n").materials[0].unsupported, (std::vector<std::string>{"map_ka"}));
  EXPECT_TRUE(parsed_mtl("newmtl a\nmap_Ka a.png\nmap_Kd a.png\nnewmtl b\n").materials[0].unsupported.empty());
  EXPECT_TRUE(parsed_mtl("newmtl a\nmap_Ka a.png\nnewmtl b\n").materials[1].unsupported.empty());
}

TEST(ParseMtl, ReadsTheKeysOfLayers) {
  const Parsed p =
      parsed_mtl("newmtl a\nPs 0.1\nPc 0.2\nPcr 0.3\naniso 0.4\nanisor 0.5\nNi 1.33\nmap_Ks s.png\nmap_Ns n.png\n");
  const MtlMaterial& m = p.materials.at(0);
  EXPECT_EQ(m.sheen, 0.1f);
  EXPECT_EQ(m.clearcoat, 0.2f);
  EXPECT_EQ(m.clearcoat_roughness, 0.3f);
  EXPECT_EQ(m.anisotropy, 0.4f);
  EXPECT_EQ(m.anisotropy_rotation, 0.5f);
  EXPECT_EQ(m.index_of_refraction, 1.33f);
  EXPECT_EQ(m.specular_map.file, "s.png");
  EXPECT_EQ(m.exponent_map.file, "n.png");
  EXPECT_EQ(m.roughness_map.file, "");
  EXPECT_TRUE(p.warnings.empty());
  EXPECT_TRUE(m.unsupported.empty());
}

TEST(ParseMtl, TakesTimeInProportionToALinesLength) {
  std::string text = "newmtl a\nmap_Kd";
  for (int i = 0; i < 100000; ++i) text += " -o 1 2 3";
  std::vector<std::string> warnings;
  const std::vector<MtlMaterial> found = parse_mtl(text + " x.png", "a.mtl", warnings);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].diffuse_map.file, "x.png");
}

TEST(ParseMtl, PassesOverWhatIsWrong) {
  const Parsed p = parsed_mtl("Kd 1 1 1\nnewmtl a\nKd red\nKs\nNs nan\nwhatever 3\nmap_Kd\nKd spectral x.rfl\n");
  EXPECT_EQ(p.materials.size(), 1u);
  EXPECT_EQ(p.warnings, (std::vector<std::string>{
                            "a.mtl: line 1: kd before newmtl is ignored", "a.mtl: line 3: kd: 'red' is not a number",
                            "a.mtl: line 4: ks has no numbers", "a.mtl: line 5: ns: 'nan' is not a number",
                            "a.mtl: line 6: 'whatever' is unknown and ignored", "a.mtl: line 7: map_kd names no file",
                            "a.mtl: line 8: kd: 'spectral' is not a number"}));
  std::string many = "newmtl a\n";
  for (int i = 0; i < 1000; ++i) many += "bad\n";
  EXPECT_EQ(parsed_mtl(many).warnings.size(), 20u);
}

TEST(ParseMtl, KeepsTheMaterialsThatAreWanted) {
  std::vector<std::string> warnings, names;
  const auto is_b = [&](const std::string& name) { return names.push_back(name), name == "b"; };
  const auto found = parse_mtl("newmtl a\nKd 1 0 0\nKs x\nnewmtl b\nKd 0 1 0\nnewmtl c\n", "f.mtl", warnings, is_b);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "b");
  EXPECT_EQ(found[0].diffuse, (float3{0, 1, 0}));
  EXPECT_EQ(names, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(warnings.size(), 1u);  // errors in the other materials are reported nevertheless
}

TEST(ParseMtl, NamesEachMapThatIsNotDrawnOnce) {
  std::string text = "newmtl a\n";
  for (int i = 0; i < 1000; ++i) text += "decal x\nmap_" + std::to_string(i) + " x\n";
  std::vector<std::string> warnings;
  const auto found = parse_mtl(text, "f.mtl", warnings);
  EXPECT_LE(found.at(0).unsupported.size(), 16u);
  EXPECT_EQ(std::count(found[0].unsupported.begin(), found[0].unsupported.end(), "decal"), 1);
}

}  // namespace
}  // namespace zoneplate
