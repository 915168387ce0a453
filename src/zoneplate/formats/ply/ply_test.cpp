// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/ply/ply.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>

#include "zoneplate/base/parallel.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/geometry/smooth_normals.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

Scene loaded_ply(const Bytes& bytes) {
  const MemoryFile file;
  return load_ply(file.write(bytes));
}
Scene loaded_ply(const std::string& text) { return loaded_ply(Bytes(text.begin(), text.end())); }

std::string ply_refusal(const std::string& text) {
  const MemoryFile file;
  const std::string path = file.write(Bytes(text.begin(), text.end()));
  const std::string error = load_soundly(load_ply, path);
  EXPECT_TRUE(error.starts_with(path + ": ")) << error;
  return error.substr(std::min(error.size(), path.size() + 2));
}

const std::string ascii = "ply\nformat ascii 1.0\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

TEST(Ply, AsciiQuadWithColorsAndUv) {
  const Scene s =
      loaded_ply(ascii + "comment by hand\nelement vertex 4\n" + xyz +
                 "property float s\nproperty float t\nproperty uchar red\nproperty uchar green\n"
                 "property uchar blue\nproperty uchar alpha\nelement face 1\n"
                 "property list uchar int vertex_indices\nend_header\n"
                 "0 0 0 0 0 255 0 0 255\n1 0 0 1 0 0 128 0 255\n1 1 0 1 1 0 0 0 51\n0 1 0 0 0.75 9 9 9 255\n"
                 "4 0 1 2 3\n");
  ASSERT_EQ(s.meshes.size(), 1u);
  const Mesh& m = s.meshes[0];
  EXPECT_EQ(m.index, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(m.uv0[3], (float2{0, 0.25f}));
  EXPECT_EQ(m.color[0], (float4{1, 0, 0, 1}));
  EXPECT_EQ(m.color[1], (float4{0, decode_srgb8(128), 0, 1}));
  EXPECT_EQ(m.color[2].w, 0.2f);
  EXPECT_EQ(m.normal[2], (float3{0, 0, 1}));
  EXPECT_EQ(s.materials[0].alpha_mode, AlphaMode::Blend);
}

// Their colours are coefficients of spherical harmonics, and their normals are zero.
TEST(Ply, GaussianSplatsArePointsOfTheirColor) {
  const std::string head =
      ascii + "element vertex 2\n" + xyz +
      "property float nx\nproperty float ny\nproperty float nz\nproperty float f_dc_0\nproperty float f_dc_1\n"
      "property float f_dc_2\nproperty float opacity\nproperty float scale_0\nproperty float rot_0\nend_header\n";
  const Scene s = loaded_ply(head + "0 0 0 0 0 0 0.5 -9 9 -4 1 1\n1 0 0 0 0 0 0 0 nan 4 1 1\n");
  const Mesh& m = s.meshes.at(0);
  EXPECT_EQ(m.topology, Topology::Points);
  EXPECT_TRUE(m.normal.empty());
  EXPECT_EQ(m.color.at(0), (float4{decode_srgb(0.5f + 0.28209479f * 0.5f), 0, 1, 1}));
  EXPECT_EQ(m.color.at(1), (float4{decode_srgb(0.5f), decode_srgb(0.5f), 0, 1}));
  EXPECT_EQ(s.materials.at(0).base_color, (float4{1, 1, 1, 1}));
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_TRUE(s.warnings[0].ends_with(
      ": looks like Gaussian splats: only their centres are drawn, as points of their mean colours"))
      << s.warnings[0];
}

/// A pyramid whose coordinates have the given type and byte order.
template <class T>
Bytes pyramid(const char* type, bool is_big) {
  std::string head = std::string("ply\nformat binary_") + (is_big ? "big" : "little") +
                     "_endian 1.0\nelement vertex 4\nproperty uchar skipped\n";
  for (const char* axis : {"z", "x", "y"}) head += std::string("property ") + type + " " + axis + "\n";
  head += std::string("element face 2\nproperty list ") + "uchar uint vertex_index\nend_header\n";
  Bytes out(head.begin(), head.end());
  const auto add = [&](auto value) {
    std::uint8_t raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    for (std::size_t i = 0; i < sizeof value; ++i) out.push_back(raw[is_big ? sizeof value - 1 - i : i]);
  };
  for (int v = 0; v < 4; ++v) {
    add(std::uint8_t{77});
    for (int c = 0; c < 3; ++c) add(static_cast<T>((v * 3 + c * 5) % 7));
  }
  add(std::uint8_t{4});
  for (std::uint32_t i : {0u, 1u, 2u, 3u}) add(i);
  add(std::uint8_t{3});
  for (std::uint32_t i : {3u, 2u, 1u}) add(i);
  return out;
}

template <class T>
void expect_pyramid(const char* type) {
  for (const bool is_big : {false, true}) {
    const Scene s = loaded_ply(pyramid<T>(type, is_big));
    const Mesh& m = s.meshes[0];
    EXPECT_EQ(m.primitives(), 3u) << type;
    for (std::size_t k : {0u, 1u, 2u})
      EXPECT_EQ(m.position[k], (float3{static_cast<float>((k * 3 + 5) % 7), static_cast<float>((k * 3 + 10) % 7),
                                       static_cast<float>(k * 3 % 7)}))
          << type;
  }
}

TEST(Ply, EveryTypeInEveryByteOrder) {
  expect_pyramid<std::int8_t>("char"), expect_pyramid<std::uint8_t>("uint8"), expect_pyramid<std::int16_t>("short");
  expect_pyramid<std::uint16_t>("uint16"), expect_pyramid<std::int32_t>("int"), expect_pyramid<std::uint32_t>("uint32");
  expect_pyramid<float>("float32"), expect_pyramid<double>("double");
}

TEST(Ply, PlainTrianglesAndListsOfAnyLengthAgreeForAnyNumberOfThreads) {
  // A strip of squares: with triangles only, which takes the fast path, and with one pentagon at the end, which does
  // not.
  const int n = 20000;
  for (const bool has_pentagon : {false, true}) {
    std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(n) + "\n" + xyz +
                       "element face " + std::to_string(n - 2 + (has_pentagon ? 1 : 0)) +
                       "\nproperty list uchar int vertex_indices\nend_header\n";
    Bytes bytes(head.begin(), head.end());
    const auto add = [&](auto value) {
      const auto* raw = reinterpret_cast<const std::uint8_t*>(&value);
      bytes.insert(bytes.end(), raw, raw + sizeof value);
    };
    for (int i = 0; i < n; ++i) add(static_cast<float>(i / 2)), add(static_cast<float>(i % 2)), add(0.0f);
    for (int i = 0; i + 2 < n; ++i) {
      add(std::uint8_t{3});
      for (const int k : {i, i + 1 + i % 2, i + 2 - i % 2}) add(k);
    }
    if (has_pentagon) {
      add(std::uint8_t{5});
      for (int k : {0, 2, 4, 3, 1}) add(k);
    }
    Scene one, four;
    with_threads(1, [&] { one = loaded_ply(bytes); });
    with_threads(4, [&] { four = loaded_ply(bytes); });
    EXPECT_EQ(one.meshes[0].primitives(), static_cast<std::size_t>(n - 2 + (has_pentagon ? 3 : 0)));
    EXPECT_EQ(one.meshes[0].index[3 * 777], 777u);
    EXPECT_EQ(one.meshes[0].index, four.meshes[0].index);
    EXPECT_EQ(one.meshes[0].position, four.meshes[0].position);
    EXPECT_EQ(one.meshes[0].normal, four.meshes[0].normal);
  }
}

TEST(Ply, PointsLinesAndStrips) {
  const std::string vertices = "element vertex 4\n" + xyz;
  const std::string body = "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  const Scene points = loaded_ply(ascii + vertices + body);
  EXPECT_EQ(points.meshes[0].topology, Topology::Points);
  EXPECT_EQ(points.meshes[0].primitives(), 4u);
  const Scene lines = loaded_ply(ascii + vertices + "element edge 2\nproperty int vertex1\nproperty int vertex2\n" +
                                 body + "0 1\n3 2\n");
  EXPECT_EQ(lines.meshes[0].topology, Topology::Lines);
  EXPECT_EQ(lines.meshes[0].index, (std::vector<std::uint32_t>{0, 1, 3, 2}));
  const Scene strips = loaded_ply(ascii + vertices + "element tristrips 1\nproperty list int int vertex_indices\n" +
                                  body + "8 0 1 2 3 -1 0 2 1\n");
  std::vector<float3> corners;
  for (const std::uint32_t k : strips.meshes[0].index) corners.push_back(strips.meshes[0].position[k]);
  constexpr float3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{1, 1, 0};
  EXPECT_EQ(corners, (std::vector<float3>{a, b, c, c, b, d, a, c, b}));
}

TEST(Ply, FacesMayHaveTheirOwnUvColorAndTexture) {
  const TestFolder folder;
  folder.write("a b.png", encode_png(Rgba8Image(2, 2, {1, 2, 3, 255})));
  const std::string text =
      ascii + "comment TextureFile  a b.png\nelement vertex 3\n" + xyz +
      "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1 255 0 0\n3 0 1 2 6 0.5 0.5 1 1 0 0 0 0 255\n";
  const Scene s = load_ply(folder.write("model.ply", text));
  const Mesh& m = s.meshes[0];
  ASSERT_EQ(m.position.size(), 6u);
  EXPECT_EQ(m.uv0[0], (float2{0, 1}));
  EXPECT_EQ(m.uv0[3], (float2{0.5f, 0.5f}));
  EXPECT_EQ(m.color[0], (float4{1, 0, 0, 1}));
  EXPECT_EQ(m.color[5], (float4{0, 0, 1, 1}));
  EXPECT_EQ(s.materials[0].base_color_texture.image, 0);
  EXPECT_EQ(s.images[0].name, "a b.png");
}

TEST(Ply, UniformGreyDoesNotDarkenATexture) {
  const TestFolder folder;
  folder.write("a.png", encode_png(Rgba8Image(2, 2, {1, 2, 3, 255})));
  const auto colors_of = [&](const std::string& comment, const std::string& last) {
    const std::string text = ascii + comment + "element vertex 3\n" + xyz +
                             "property float s\nproperty float t\nproperty uchar red\nproperty uchar green\n"
                             "property uchar blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                             "0 0 0 0 0 192 192 192\n1 0 0 1 0 192 192 192\n0 1 0 0 1 " +
                             last + "\n3 0 1 2\n";
    return load_ply(folder.write("model.ply", text)).meshes[0].color.size();
  };
  const std::string texture = "comment TextureFile a.png\n";
  EXPECT_EQ(colors_of(texture, "192 192 192"), 0u);
  EXPECT_EQ(colors_of(texture, "192 192 191"), 3u);
  EXPECT_EQ(colors_of("", "192 192 192"), 3u);
}

TEST(Ply, ColoursOfWideTypesMayBeThoseOfBytes) {
  const auto color_of = [](const std::string& type, const std::string& first) {
    const std::string red = "property " + type + " red\n", green = "property " + type + " green\n",
                      blue = "property " + type + " blue\n";
    return loaded_ply(ascii + "element vertex 3\n" + xyz + red + green + blue +
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " + first +
                      "\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n")
        .meshes.at(0)
        .color.at(0);
  };
  for (const char* type : {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"})
    EXPECT_EQ(color_of(type, "255 0 128"), (float4{1, 0, decode_srgb8(128), 1})) << type;
  EXPECT_EQ(color_of("ushort", "65535 0 0"), (float4{1, 0, 0, 1}));
  EXPECT_EQ(color_of("float", "1 0 0.5"), (float4{1, 0, decode_srgb(0.5f), 1}));
}

TEST(Ply, AlphaThatIsZeroEverywhereIsNotMeant) {
  const auto load_with = [](const char* alpha) {
    return loaded_ply(ascii + "element vertex 3\n" + xyz +
                      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                      "0 0 0 9 9 9 0\n1 0 0 9 9 9 0\n0 1 0 9 9 9 " +
                      alpha + "\n3 0 1 2\n");
  };
  const Scene all = load_with("0"), some = load_with("1");
  EXPECT_EQ(all.meshes[0].color[0].w, 1);
  EXPECT_EQ(all.materials[0].alpha_mode, AlphaMode::Opaque);
  ASSERT_EQ(all.warnings.size(), 1u);
  EXPECT_TRUE(all.warnings[0].ends_with("the alpha of all vertices is 0, taken as 1"));
  EXPECT_EQ(some.meshes[0].color[0].w, 0);
}

TEST(Ply, FacesMayHaveSeveralTextures) {
  const TestFolder folder;
  for (const char* name : {"a.png", "b.png", "c.png"}) folder.write(name, encode_png(Rgba8Image(2, 2, {1, 2, 3, 255})));
  const std::string text =
      ascii + "comment TextureFile a.png\ncomment TextureFile b.png\ncomment TextureFile c.png\nelement vertex 4\n" +
      xyz +
      "element face 3\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "property int texnumber\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
      "3 0 1 2 6 0 0 1 0 1 1 2\n3 0 2 3 6 0 0 1 1 0 1 0\n3 0 1 3 6 0 0 1 0 0 1 9\n";
  const Scene s = load_ply(folder.write("model.ply", text));
  ASSERT_EQ(s.meshes.size(), 2u);
  EXPECT_EQ(s.meshes[0].primitives(), 2u);  // a number that no texture has is that of the first
  EXPECT_EQ(s.meshes[1].primitives(), 1u);
  EXPECT_EQ(s.meshes[1].uv0[1], (float2{1, 1}));
  const auto image_of = [&](std::size_t mesh) {
    const Material& m = s.materials[static_cast<std::size_t>(s.meshes[mesh].material)];
    return s.images.at(static_cast<std::size_t>(m.base_color_texture.image)).name;
  };
  EXPECT_EQ(image_of(0), "a.png");
  EXPECT_EQ(image_of(1), "c.png");
  EXPECT_EQ(s.objects.size(), 1u);
}

TEST(Ply, OneFlawDoesNotCostTheModel) {
  const std::string faces = "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const auto warning_of = [](const std::string& text, std::size_t triangles) {
    const Scene s = loaded_ply(text);
    EXPECT_EQ(s.meshes.at(0).primitives(), triangles);
    EXPECT_EQ(s.warnings.size(), 1u);
    return s.warnings.empty() ? "" : s.warnings[0].substr(s.warnings[0].find(": ") + 2);
  };
  EXPECT_EQ(
      warning_of(ascii + "Made by hand\nelement vertex 3\n" + xyz + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n",
                 2),
      "line 3: 'Made' is not a word of a PLY header, the line is ignored");
  EXPECT_EQ(warning_of(ascii + "element vertex 3\n" + xyz + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n3 0 1 2\n", 1),
            "face 0 uses vertex 3, there are 3: it is dropped");
  EXPECT_EQ(
      warning_of(
          ascii + "element vertex 3\n" + xyz + faces + "0 0 0 7 7 7\n1 0 0 7 7 7\n0 1 0 7 7 7\n3 0 1 2\n3 0 1 2\n", 2),
      "rows have more values than the header states, the rest is ignored");
  EXPECT_EQ(
      warning_of(ascii + "element vertex 3\n" + xyz + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\nmade by hand\n",
                 2),
      "line 15: 'made' follows the last row, the rest is ignored");
  EXPECT_EQ(
      warning_of(
          ascii + "element vertex 3\n" + xyz + faces + "0 0 0\n1 0 0\n\n0 1 0\n3 0 1 2 0.5 0.5\n3 0 1 2 0.5 0.5\n", 2),
      "rows have more values than the header states, the rest is ignored");
}

TEST(Ply, NormalsDecideWhichSideIsOutside) {
  const Scene s = loaded_ply(ascii + "element vertex 3\n" + xyz +
                             "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n"
                             "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 2 1\n");
  EXPECT_EQ(s.meshes[0].index, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Ply, WhatIsNotFiniteIsDropped) {
  const Scene s = loaded_ply(ascii + "element vertex 4\n" + xyz +
                             "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\nnan 0 0\n3 0 1 2\n3 0 1 3\n");
  EXPECT_EQ(s.meshes[0].primitives(), 1u);
  EXPECT_EQ(s.warnings.size(), 1u);
}

TEST(Ply, Refusals) {
  EXPECT_EQ(ply_refusal("plyx\n"), "line 1: does not begin with 'ply'");
  EXPECT_EQ(ply_refusal("ply\nformat ascii 2.0\n"), "line 2: version '2.0', expected 1.0");
  EXPECT_EQ(ply_refusal(ascii + "element vertex many\n"), "line 3: element vertex: 'many' is not a number of elements");
  EXPECT_EQ(ply_refusal(ascii + "property float x\n"), "line 3: a property before the first element");
  EXPECT_EQ(ply_refusal(ascii + "element vertex 1\nproperty real x\n"), "line 4: property: 'real' is not a type");
  EXPECT_EQ(ply_refusal(ascii + "element vertex 1\n"), "line 3: the header has no end_header");
  EXPECT_EQ(ply_refusal(ascii + "end_header\n"), "has no element vertex");
  EXPECT_EQ(ply_refusal(ascii + "element vertex 1\nproperty float x\nend_header\n1\n"),
            "element vertex: has no x, y and z");
  EXPECT_EQ(ply_refusal(ascii + "element vertex 1\n" + xyz + "end_header\n1 2\n"),
            "element vertex: the file ends in row 0 of 1");
  EXPECT_EQ(ply_refusal(ascii + "element vertex 1\n" + xyz + "end_header\n1 two 3\n"), "line 8: 'two' is not a number");
  EXPECT_EQ(ply_refusal(ascii + "element vertex 2\n" + xyz + "end_header\n1 2 3\n4 five 6\n"),
            "line 9: 'five' is not a number");
  EXPECT_EQ(
      ply_refusal(ascii + "element vertex 1\n" + xyz +
                  "element face 2\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n3 0 0 1\n3 0 0 1\n"),
      "face 0 uses vertex 1, there are 1: it is dropped (and 1 more); nothing is left to draw");
}

/// The normal of each corner of a mesh, in the order of its indices.
std::vector<float3> corner_normals(const Mesh& m) {
  std::vector<float3> out;
  for (const std::uint32_t i : m.index) out.push_back(m.normal[i]);
  return out;
}

TEST(SmoothNormals, AnEdgeOf90DegreesStaysAndOneOf20DegreesGoes) {
  // Two squares that share an edge on the y axis; the second one is rotated by the angle.
  for (const float degrees : {20.0f, 90.0f}) {
    const float c = std::cos(degrees * 0.017453292f), s = std::sin(degrees * 0.017453292f);
    Mesh m;
    m.position = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {c, 0, -s}, {c, 1, -s}};
    m.index = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
    make_smooth_normals(m);
    const std::vector<float3> n = corner_normals(m);
    EXPECT_EQ(m.position.size(), degrees > 50 ? 8u : 6u);
    EXPECT_NEAR(dot(n[1], n[6]), degrees > 50 ? 0 : 1, 1e-6f);
    EXPECT_EQ(n[0], (float3{0, 0, 1}));
    for (const float3 v : n) EXPECT_NEAR(length(v), 1, 1e-6f);
  }
}

/// Smooth terrain with a rough part, 60 × 60 squares, whose triangles are in a scattered order.
Mesh rough_land() {
  constexpr std::uint32_t n = 60;
  Mesh m;
  for (std::uint32_t i = 0; i < (n + 1) * (n + 1); ++i) {
    const std::uint32_t x = i % (n + 1), z = i / (n + 1);
    const float rough = x > 20 && x < 40 ? 1.5f : 0.1f;
    m.position.push_back({static_cast<float>(x), rough * unit_float(hash(i)), static_cast<float>(z)});
  }
  for (std::uint32_t k = 0; k < n * n; ++k) {
    const std::uint32_t square = k * 1009 % (n * n), a = square / n * (n + 1) + square % n;
    m.index.insert(m.index.end(), {a, a + n + 1, a + 1, a + 1, a + n + 1, a + n + 2});
  }
  return m;
}

/// A reference implementation of smooth normals, for all corners.
std::vector<float3> defined_normals(const Mesh& m) {
  std::vector<std::vector<std::size_t>> about(m.position.size());
  for (std::size_t k = 0; k < m.index.size(); ++k) about[m.index[k]].push_back(k);
  const auto at = [&](std::size_t corner, std::size_t step) {
    return m.position[m.index[corner / 3 * 3 + (corner + step) % 3]];
  };
  const auto area = [&](std::size_t corner) {
    const std::size_t first = corner / 3 * 3;
    return cross(at(first, 1) - at(first, 0), at(first, 2) - at(first, 0));
  };
  std::vector<float3> out;
  for (std::size_t k = 0; k < m.index.size(); ++k) {
    const float3 own = normalize(area(k));
    float3 sum;
    for (const std::size_t c : about[m.index[k]]) {
      const float3 p = m.position[m.index[c]];
      float3 ends[2];
      for (std::size_t j = 0, e = 0; j < 3; ++j)
        if (c / 3 * 3 + j != c) ends[e++] = m.position[m.index[c / 3 * 3 + j]] - p;
      const float3 normal = area(c);
      if (dot(normalize(normal), own) > 0.64278761f)
        sum += normal * (1 / (dot(ends[0], ends[0]) * dot(ends[1], ends[1])));
    }
    out.push_back(normalize(sum));
  }
  return out;
}

TEST(SmoothNormals, AreTheirDefinitionForAnyNumberOfThreads) {
  const Mesh land = rough_land();
  const std::vector<float3> expected = defined_normals(land);
  std::vector<float3> first;
  for (const int threads : {1, 2, 5}) {
    Mesh m = land;
    with_threads(threads, [&] { make_smooth_normals(m); });
    EXPECT_GT(m.position.size(), land.position.size() + 500);
    const std::vector<float3> found = corner_normals(m);
    if (first.empty()) first = found;
    ASSERT_EQ(found, first) << threads;
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_GT(dot(found[i], expected[i]), 0.99999f) << i;
  }
}

TEST(SmoothNormals, AreThoseOfTheSphereWhoseVerticesTheyAre) {
  // An octahedron with irregular points around its top: the weights make the normal exact for any triangles.
  Mesh m;
  m.position = {{0, 1, 0}};
  const float tilt[] = {0.2f, 0.5f, 0.3f, 0.6f, 0.4f};
  for (int i = 0; i < 5; ++i) {
    const float a = 1.1f * static_cast<float>(i) + 0.3f * tilt[i];
    m.position.push_back({std::sin(tilt[i]) * std::cos(a), std::cos(tilt[i]), -std::sin(tilt[i]) * std::sin(a)});
  }
  for (std::uint32_t i = 0; i < 5; ++i) m.index.insert(m.index.end(), {0, 1 + i, 1 + (i + 1) % 5});
  make_smooth_normals(m);
  EXPECT_NEAR(m.normal[0].y, 1, 1e-6f);
}

/// A point cloud of doubles, 1 cm apart in a far place, as text or binary; with a list of another length in each row
/// or without.
Bytes far_cloud(bool is_binary, bool has_lists) {
  const std::string order = is_binary ? "binary_little_endian" : "ascii";
  const std::string head = "ply\nformat " + order +
                           " 1.0\nelement vertex 3600\nproperty double x\nproperty double y\nproperty double z\n" +
                           (has_lists ? "property list uchar uchar more\n" : "") + "end_header\n";
  Bytes out(head.begin(), head.end());
  for (int i = 0; i < 3600; ++i) {
    const std::array<double, 3> p = {500000 + 0.01 * (i % 60), 5200000 + 0.01 * (i / 60), 100.5};
    const int items = has_lists ? i % 3 : -1;
    std::string text = fmt::format("{:.2f} {:.2f} {}", p[0], p[1], p[2]);
    if (has_lists) text += fmt::format(" {}", items);
    for (int k = 0; k < items; ++k) text += " 7";
    if (!is_binary) {
      out.insert(out.end(), text.begin(), text.end()), out.push_back('\n');
      continue;
    }
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(p.data());
    out.insert(out.end(), bytes, bytes + sizeof p);
    if (has_lists) out.push_back(static_cast<std::uint8_t>(items));
    for (int k = 0; k < items; ++k) out.push_back(7);
  }
  return out;
}

TEST(Ply, DoublesFarFromTheOriginKeepTheirPlaces) {
  for (const bool is_binary : {false, true})
    for (const bool has_lists : {false, true}) {
      const Scene s = loaded_ply(far_cloud(is_binary, has_lists));
      EXPECT_EQ(s.origin, (double3{500000.3125, 5200000.3125, 100.5}));
      for (int i = 0; i < 3600; ++i) {
        const double3 p = s.in_file(s.meshes[0].position[static_cast<std::size_t>(i)]);
        EXPECT_NEAR(p.x, 500000 + 0.01 * (i % 60), 2e-8) << i;
        EXPECT_NEAR(p.y, 5200000 + 0.01 * (i / 60), 2e-8) << i;
        EXPECT_EQ(p.z, 100.5);
      }
    }
}

TEST(Ply, FloatsFarFromTheOriginKeepTheirBits) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 2\n" + xyz + "end_header\n";
  const Scene far = loaded_ply(head + "4200000.5 7 0\n4200001 7 0\n"),
              near = loaded_ply(head + "60.1 7 0\n61.3 7.7 0.3\n");
  EXPECT_EQ(far.in_file(far.meshes[0].position[0]), (double3{4200000.5, 7, 0}));
  EXPECT_NE(far.origin, double3{});
  EXPECT_EQ(near.origin, double3{});
  EXPECT_EQ(near.meshes[0].position, (std::vector<float3>{{60.1f, 7, 0}, {61.3f, 7.7f, 0.3f}}));
}

}  // namespace
}  // namespace zoneplate
