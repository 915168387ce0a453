// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/amf/amf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/zip/zip_for_test.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Texts = std::vector<std::string>;

Scene loaded_amf(const Bytes& bytes, const LoadLimits& limits = {}) {
  const MemoryFile file;
  Scene scene = load_amf(file.write(bytes), limits);
  expect_sound(scene);
  return scene;
}
Scene loaded_amf(const std::string& text, const LoadLimits& limits = {}) {
  return loaded_amf(Bytes(text.begin(), text.end()), limits);
}

std::string refusal(const std::string& text, const LoadLimits& limits = {}) {
  const MemoryFile file;
  const std::string path = file.write({text.begin(), text.end()});
  try {
    load_amf(path, limits);
  } catch (const Error& error) {
    return std::string(error.what()).substr(path.size() + 2);
  }
  return "";
}

Texts amf_warnings(const Scene& scene) {
  Texts out;
  for (const std::string& w : scene.warnings) out.push_back(w.substr(w.find(": ") + 2));
  return out;
}

std::string vertex(int x, int y, int z, const std::string& more = "") {
  return fmt::format("<vertex><coordinates><x>{}</x>\n<y> {} </y><z>{}</z></coordinates>{}</vertex>", x, y, z, more);
}
std::string triangle(int a, int b, int c, const std::string& more = "") {
  return fmt::format("<triangle>{}<v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>", more, a, b, c);
}
std::string color(float r, float g, float b) {
  return fmt::format("<color><r>{}</r><g>{}</g><b>{}</b></color>", r, g, b);
}
std::string square() { return vertex(0, 0, 0) + vertex(1, 0, 0) + vertex(1, 1, 0) + vertex(0, 1, 3); }
std::string object(int id, const std::string& vertices, const std::string& volumes, const std::string& more = "") {
  return fmt::format("<object id=\"{}\">{}<mesh><vertices>{}</vertices>{}</mesh></object>", id, more, vertices,
                     volumes);
}
std::string volume(const std::string& triangles, const std::string& attributes = "", const std::string& more = "") {
  return "<volume " + attributes + ">" + more + triangles + "</volume>";
}
std::string amf(const std::string& content, const std::string& unit = "millimeter") {
  return "<?xml version=\"1.0\"?><amf unit=\"" + unit + "\" version=\"1.1\">" + content + "</amf>";
}
std::string plain() { return amf(object(0, square(), volume(triangle(0, 1, 2) + triangle(0, 2, 3)))); }

const Material& amf_material(const Scene& s, std::size_t mesh) {
  return s.materials.at(static_cast<std::size_t>(s.meshes.at(mesh).material));
}

// A plain file, without colours, is not black, as by assimp 5.2. Printers have +Z up.
TEST(LoadAmf, APlainFileIsUprightAndGrey) {
  for (const Scene& s : {loaded_amf(plain()), loaded_amf(zip_of({{"a.txt", "?"}, {"a.amf", plain(), true}}))}) {
    EXPECT_EQ(s.up, (float3{0, 0, 1}));
    EXPECT_EQ(s.bounds().high, (float3{1, 1, 3}));
    EXPECT_EQ(s.meshes.at(0).primitives(), 2u);
    EXPECT_TRUE(s.meshes[0].color.empty());
    EXPECT_TRUE(amf_material(s, 0).is_default);
    EXPECT_EQ(amf_warnings(s), Texts{});
  }
}

TEST(LoadAmf, ColoursOfMaterialsObjectsVolumesVerticesAndTriangles) {
  const std::string vertices = vertex(0, 0, 0, color(0, 1, 0)) + vertex(1, 0, 0) + vertex(1, 1, 0) + vertex(0, 1, 3);
  const Scene s = loaded_amf(amf(
      object(1, vertices,
             volume(triangle(1, 2, 3) + triangle(0, 1, 2) + triangle(1, 3, 2, color(0, 0, 1)), "materialid=\"2\"")) +
      object(2, square(), volume(triangle(0, 1, 2), "materialid=\"2\"") + volume(triangle(0, 2, 3), "", color(1, 1, 0)),
             "<metadata type=\"name\">part</metadata>" + color(0.5f, 0.5f, 0.5f)) +
      "<material id=\"2\"><metadata type=\"name\">red</metadata>" + color(1, 0, 0) + "</material>"));
  ASSERT_EQ(s.meshes.size(), 3u);
  std::size_t colored = 0;
  for (std::size_t m = 0; m < 2; ++m) {
    const Mesh& mesh = s.meshes[m];
    if (mesh.color.empty()) {
      EXPECT_EQ(amf_material(s, m).name, "red");
      EXPECT_EQ(amf_material(s, m).base_color, (float4{1, 0, 0, 1}));
      EXPECT_EQ(mesh.primitives(), 1u);
      continue;
    }
    ++colored;
    EXPECT_EQ(mesh.color[mesh.index[0]], (float4{0, 1, 0, 1}));
    EXPECT_EQ(mesh.color[mesh.index[1]], (float4{1, 0, 0, 1})) << "that of the material below";
    EXPECT_EQ(mesh.color[mesh.index[3]], (float4{0, 0, 1, 1}));
  }
  EXPECT_EQ(colored, 1u);
  const Mesh& part = s.meshes[2];
  EXPECT_EQ(part.name, "part");
  const float grey = decode_srgb(0.5f);
  EXPECT_EQ(part.color[part.index[0]], (float4{grey, grey, grey, 1}))
      << "that of the object before that of the material";
  EXPECT_EQ(part.color[part.index[3]], (float4{1, 1, 0, 1}));
}

TEST(LoadAmf, VerticesWithoutAColourAreThoseBelowAndAreShared) {
  constexpr int n = 20;
  std::string vertices, triangles;
  for (int i = 0; i < n * n; ++i) vertices += vertex(i % n, i / n, 0, i % 2 != 0 ? color(1, 0, 0) : "");
  for (int y = 0; y + 1 < n; ++y)
    for (int a = y * n; a + 1 < (y + 1) * n; ++a)
      triangles += triangle(a, a + 1, a + n) + triangle(a + 1, a + n + 1, a + n);
  const std::string material = "<material id=\"2\">" + color(0, 0, 1) + "</material>";
  const std::pair<std::string, float4> cases[] = {{"materialid=\"2\"", {0, 0, 1, 1}},
                                                  {"materialid=\"3\"", plain_material("").base_color},
                                                  {"", plain_material("").base_color}};
  for (const auto& [attribute, below] : cases) {
    const Scene s = loaded_amf(amf(object(0, vertices, volume(triangles, attribute)) + material));
    const Mesh& mesh = s.meshes.at(0);
    EXPECT_EQ(mesh.position.size(), std::size_t{n * n});
    for (std::size_t i = 0; i < mesh.position.size(); ++i)
      EXPECT_EQ(mesh.color.at(i), static_cast<int>(mesh.position[i].x) % 2 != 0 ? (float4{1, 0, 0, 1}) : below);
  }
}

TEST(LoadAmf, ConstellationsPlaceObjects) {
  const Scene s = loaded_amf(
      amf(object(1, square(), volume(triangle(0, 1, 2))) +
              "<constellation id=\"5\"><instance objectid=\"1\"><deltax>10</deltax><rz>90</rz></instance>"
              "<instance objectid=\"1\"><deltay>5</deltay><rx>180</rx><rz>90</rz></instance></constellation>"
              "<constellation id=\"6\"><instance objectid=\"5\"><deltaz>1</deltaz></instance></constellation>",
          "inch"));
  ASSERT_EQ(s.instances.size(), 2u);
  const auto corner = [&](std::size_t i) { return s.instances[i].world_from_object * float4{25.4f, 25.4f, 0, 1}; };
  EXPECT_EQ(corner(0), (float4{254 - 25.4f, 25.4f, 25.4f, 1}));
  EXPECT_EQ(corner(1), (float4{25.4f, 127 + 25.4f, 25.4f, 1}));
}

TEST(LoadAmf, OneFlawDoesNotCostTheModel) {
  const auto with = [](const std::string& triangles, const std::string& more) {
    return amf(object(0, square(), volume(triangle(0, 1, 2) + triangles)) + more);
  };
  const std::pair<std::string, std::string> cases[] = {
      {with(triangle(0, 1, 9), ""), "object 0, triangle 1 uses vertex 9, there are 4: it is dropped"},
      {with(triangle(0, 1, 2, "<color><r>x+1</r></color>"), ""),
       "a colour is no number (formulas are not read): it is taken as white"},
      {with("", "<constellation id=\"3\"><instance objectid=\"0\"/><instance objectid=\"8\"/></constellation>"),
       "object 8 is not there: it is left out"},
      {with("", "<constellation id=\"3\"><instance objectid=\"3\"/></constellation>"),
       "object 3 contains itself: the component is left out"},
      {with("", "<constellation id=\"3\"><instance objectid=\"0\"/><instance objectid=\"3\"/></constellation>"),
       "object 3 contains itself: the component is left out"},
      {with("", "<texture id=\"1\">AA==</texture>"), "textures of AMF are not drawn"}};
  for (const auto& [text, warning] : cases) {
    const Scene s = loaded_amf(text);
    EXPECT_EQ(amf_warnings(s), Texts{warning});
    EXPECT_EQ(s.objects.size(), 1u) << warning;
  }
  EXPECT_EQ(refusal(cases[0].first, {.is_strict = true}), cases[0].second);
}

TEST(LoadAmf, AnObjectInsideAnotherOneIsSafe) {
  for (const std::string inner : {"<object id=\"2\"/>", "<object id=\"0\"/>", "<constellation id=\"2\"/>"}) {
    std::string outer = object(0, square(), volume(triangle(0, 1, 2) + triangle(60, 1, 2)));
    outer.insert(outer.find("</object>"), inner);
    const Scene s = loaded_amf(amf(outer));
    EXPECT_EQ(s.warnings.size(), 2u) << inner;
    EXPECT_TRUE(amf_warnings(s).at(0).ends_with("is inside object 0: what follows it there is left out") ||
                amf_warnings(s).at(0).ends_with("is inside object 0: what follows it there is left out (and 1 more)"));
    EXPECT_EQ(amf_warnings(s).at(1), "object 0, triangle 1 uses vertex 60, there are 4: it is dropped");
    EXPECT_EQ(s.meshes.at(0).primitives(), 1u);
  }
}

TEST(LoadAmf, RefusalsNameTheCause) {
  EXPECT_EQ(refusal("<amf><object>"), "line 1: is not well-formed XML: no element found");
  EXPECT_EQ(refusal(amf("")), "holds nothing to draw");
  EXPECT_EQ(refusal("PK\3\4"), "is no ZIP archive, or cut off");
}

TEST(LoadAmf, AnyByteChanged) {
  const MemoryFile file;
  const std::string text = amf(object(0, square(), volume(triangle(0, 1, 2, color(1, 0, 0)))));
  for (std::size_t i = 0; i < text.size(); ++i)
    for (const char c : {'<', '9', '-', 'e', '/'}) {
      Bytes bytes(text.begin(), text.end());
      bytes[i] = static_cast<std::uint8_t>(c);
      load_soundly(load_amf, file.write(bytes));
    }
}

}  // namespace
}  // namespace zoneplate
