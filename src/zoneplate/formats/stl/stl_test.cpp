// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/stl/stl.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Facet {
  std::array<float, 9> corners;
  std::uint16_t attribute = 0;
};

Bytes binary(const std::vector<Facet>& facets, std::string header = "") {
  header.resize(80, ' ');
  Bytes out(header.begin(), header.end());
  const auto add = [&](const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), bytes, bytes + size);
  };
  const auto count = static_cast<std::uint32_t>(facets.size());
  add(&count, 4);
  for (const Facet& f : facets) {
    const float normal[3] = {9, 9, 9};  // the normals of the file are ignored
    add(normal, 12), add(f.corners.data(), 36), add(&f.attribute, 2);
  }
  return out;
}

constexpr std::array<float, 9> corner = {0, 0, 0, 1, 0, 0, 0, 1, 0};

Scene loaded_stl(const Bytes& bytes) {
  const MemoryFile file;
  return load_stl(file.write(bytes));
}
Scene loaded_stl(const std::string& text) { return loaded_stl(Bytes(text.begin(), text.end())); }

std::string stl_refusal(const std::string& text) {
  const MemoryFile file;
  const std::string path = file.write(Bytes(text.begin(), text.end()));
  std::string error = load_soundly(load_stl, path);
  EXPECT_TRUE(error.starts_with(path + ": ")) << error;
  return error.substr(std::min(error.size(), path.size() + 2));
}

TEST(Stl, BinaryFacetsAreFlatAndNormalsFollowFromCorners) {
  const Scene s = loaded_stl(binary({{corner}, {{0, 0, 0, 0, 2, 0, 2, 0, 0}}}, "solid that is binary"));
  ASSERT_EQ(s.meshes.size(), 1u);
  const Mesh& m = s.meshes[0];
  EXPECT_EQ(m.position, (std::vector<float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 2, 0}, {2, 0, 0}}));
  EXPECT_EQ(m.normal, (std::vector<float3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, -1}, {0, 0, -1}, {0, 0, -1}}));
  EXPECT_EQ(m.index, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(m.color.empty());
  EXPECT_EQ(s.up, (float3{0, 0, 1}));
}

TEST(Stl, VisCamColorsHaveRedHighAndCountWhereTheirBitIsSet) {
  const Scene s = loaded_stl(binary({{corner, 0x8000 | 31 << 10}, {corner, 31 << 10}, {corner, 0x8000 | 15}}));
  const Mesh& m = s.meshes[0];
  ASSERT_EQ(m.color.size(), 9u);
  EXPECT_EQ(m.color[0], (float4{1, 0, 0, 1}));
  EXPECT_EQ(m.color[3], (float4{1, 1, 1, 1}));
  EXPECT_EQ(m.color[6], (float4{0, 0, decode_srgb(15.0f / 31), 1}));
}

TEST(Stl, MagicsColorsHaveRedLowAndTheHeadersWhereTheirBitIsSet) {
  const Scene s = loaded_stl(binary({{corner, 31}, {corner, 0x8000}}, std::string("x COLOR=\x80\x00\xff\xff", 12)));
  const Mesh& m = s.meshes[0];
  EXPECT_EQ(m.color[0], (float4{1, 0, 0, 1}));
  EXPECT_EQ(m.color[3], (float4{decode_srgb8(128), 0, 1, 1}));
}

TEST(Stl, AttributesThatAreAllZeroAreNotBlack) {
  const std::string header("x COLOR=\x80\x00\xff\xff", 12);
  const Scene all = loaded_stl(binary({{corner, 0}, {corner, 0}}, header)),
              one = loaded_stl(binary({{corner, 0}, {corner, 31}}, header));
  for (const float4 c : all.meshes[0].color) EXPECT_EQ(c, (float4{decode_srgb8(128), 0, 1, 1}));
  EXPECT_EQ(one.meshes[0].color[0], (float4{0, 0, 0, 1}));
}

TEST(Stl, AsciiSolidsAreObjectsAndLoopsPolygons) {
  const Scene s = loaded_stl(std::string(
      "  solid one two\r\nfacet normal 0 0 1\r\n outer loop\r\n vertex 0 0 0\r\n vertex 1 0 0\r\n vertex 0 1 0\r\n"
      "endloop endfacet endsolid one two\r\nsolid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 4 0 0\n"
      "vertex 1 1 0 vertex 0 4 0 endloop endfacet endsolid"));
  ASSERT_EQ(s.objects.size(), 2u);
  EXPECT_EQ(s.objects[0], "one two");
  EXPECT_EQ(s.meshes[0].primitives(), 1u);
  ASSERT_EQ(s.meshes[1].primitives(), 2u);  // concave: the triangulation splits it at (1, 1)
  for (const float3 n : s.meshes[1].normal) EXPECT_EQ(n, (float3{0, 0, 1}));
}

TEST(Stl, LongAsciiFilesAreTheSameForAnyNumberOfThreads) {
  std::string text = "solid facet trap\nfacet\n";
  text = "solid many\n";
  for (int i = 0; i < 30000; ++i) {
    if (i == 17000) text += "endsolid\nsolid facet trap\n";
    text += "facet normal 0 0 0\n outer loop\n vertex " + std::to_string(i) + " 0 0\n vertex " + std::to_string(i + 1) +
            " 0 0\n vertex 0 " + std::to_string(i) + ".5 1\n endloop\nendfacet\n";
  }
  Scene one, two;
  with_threads(1, [&] { one = loaded_stl(text); });
  with_threads(4, [&] { two = loaded_stl(text); });
  ASSERT_EQ(one.meshes.size(), 2u);
  EXPECT_EQ(one.meshes[0].primitives(), 17000u);
  EXPECT_EQ(one.meshes[1].primitives(), 13000u);
  EXPECT_EQ(one.meshes[1].position.back(), (float3{0, 29999.5f, 1}));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(one.meshes[i].position, two.meshes[i].position);
    EXPECT_EQ(one.meshes[i].normal, two.meshes[i].normal);
  }
}

TEST(Stl, MarksCommentsAndSingleLinesAreText) {
  const std::string facet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet ";
  for (const std::string front : {"\xef\xbb\xbf", "; made by hand\n", "# x\r\n// y\r\n\n", ""}) {
    const Scene s = loaded_stl(front + "solid a b " + facet + facet + "endsolid a b\n# the end");
    ASSERT_EQ(s.meshes.size(), 1u) << front;
    EXPECT_EQ(s.objects[0], "a b");
    EXPECT_EQ(s.meshes[0].primitives(), 2u);
    EXPECT_TRUE(s.warnings.empty());
  }
  EXPECT_EQ(stl_refusal("; x\nsolid a\nfacet normal 0 0 z"), "line 3: 'z' is not a number");
}

TEST(Stl, TheSizeOfTheFileDecidesHowManyFacetsThereAre) {
  for (const std::uint32_t count : {0u, 1000u, 0xffffffffu}) {
    Bytes bytes = binary({{corner}, {corner}});
    std::memcpy(&bytes[80], &count, 4);
    const Scene s = loaded_stl(bytes);
    EXPECT_EQ(s.meshes.at(0).primitives(), 2u);
    ASSERT_EQ(s.warnings.size(), 1u);
    EXPECT_TRUE(s.warnings[0].ends_with("its header states " + std::to_string(count) +
                                        " triangles, the file has 2, which are drawn"));
    bytes.pop_back();
    if (count == 0) continue;
    EXPECT_NE(stl_refusal(std::string(bytes.begin(), bytes.end())).find("or cut off"), std::string::npos) << count;
  }
}

TEST(Stl, WhatIsNotFiniteIsDropped) {
  Facet bad{corner};
  bad.corners[4] = NAN;
  const Scene s = loaded_stl(binary({{corner}, bad, {corner}}));
  EXPECT_EQ(s.meshes[0].primitives(), 2u);
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_NE(s.warnings[0].find("1 triangles that are not finite"), std::string::npos);
}

TEST(Stl, Refusals) {
  EXPECT_EQ(stl_refusal("solid nothing\nendsolid nothing\n"), "holds no triangles");
  EXPECT_EQ(stl_refusal("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0"), "line 4: 'zero' is not a number");
  EXPECT_EQ(stl_refusal("solid x\nfacets"), "line 2: 'facets' is not a word of STL");
  EXPECT_EQ(stl_refusal("hello"), "neither ASCII STL nor binary STL: 5 bytes, expected 84 at least");
  EXPECT_EQ(stl_refusal(std::string(84, 1)),
            "not an STL file, or cut off: its header states 16843009 triangles, the file has 0");
}

TEST(Stl, SolidsCountAsMemory) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += "solid\n";
  EXPECT_EQ(loaded_stl(text + "facet outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0").meshes.size(),
            1u);  // solids without loops are not kept
  text.clear();
  for (int i = 0; i < 40000; ++i) text += "solid facet outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0\n";
  for (std::size_t at = 0; (at = text.find("solid facet", at)) != text.npos;) text[at + 5] = '\n';
  EXPECT_EQ(stl_refusal(text), "needs more than the limit of 16 MB (--max-memory)");
}

TEST(Stl, TextFarFromTheOriginKeepsItsPlaces) {
  const std::string facet =
      "facet normal 0 0 1 outer loop vertex 500000.01 5200000.02 100.03 vertex 500000.04 5200000.02 "
      "100.03 vertex 500000.01 5200000.05 100.03 endloop endfacet ";
  const Scene s = loaded_stl("solid a\n" + facet + "endsolid a\nsolid b\n" + facet + "endsolid b\n");
  ASSERT_EQ(s.meshes.size(), 2u);
  EXPECT_NE(s.origin, double3{});
  for (const Mesh& mesh : s.meshes) {
    const double3 p = s.in_file(mesh.position[1]);
    EXPECT_NEAR(p.x, 500000.04, 1e-6);
    EXPECT_NEAR(p.y, 5200000.02, 1e-6);
    EXPECT_NEAR(p.z, 100.03, 1e-6);
    EXPECT_EQ(mesh.normal[0], (float3{0, 0, 1}));
  }
}

TEST(Stl, BinaryFarFromTheOriginKeepsItsFloats) {
  constexpr float x = 1000000.5f;
  const Scene s = loaded_stl(binary({{{x, 0, 0, x + 1, 0, 0, x, 1, 0}}}));
  EXPECT_NE(s.origin, double3{});
  EXPECT_EQ(s.in_file(transform_point(s.instances[0].world_from_object, s.meshes[0].position[1])),
            (double3{1000001.5, 0, 0}));
  EXPECT_LT(std::abs(s.meshes[0].position[1].x), 2);
  EXPECT_EQ(loaded_stl(binary({{{9.1f, 0, 0, 8, 0, 0, 9, 1, 0}}})).meshes[0].position[0], (float3{9.1f, 0, 0}));
}

}  // namespace
}  // namespace zoneplate
