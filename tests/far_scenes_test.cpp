// SPDX-License-Identifier: Apache-2.0
// Models far from the origin of their coordinates, as of surveys: the same images as near it.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/formats/3mf/maker_for_test.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

constexpr std::array<double3, 5> corners = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0.7}}};
constexpr std::array<std::array<int, 3>, 6> faces = {
    {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};

std::string ascii_ply(double3 at) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
  for (const double3 c : corners) text += fmt::format("{} {} {}\n", at.x + c.x, at.y + c.y, at.z + c.z);
  for (const auto& f : faces) text += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
  return text;
}

std::string obj(double3 at) {
  std::string text;
  for (const double3 c : corners) text += fmt::format("v {:.3f} {:.3f} {:.3f}\n", at.x + c.x, at.y + c.y, at.z + c.z);
  for (const auto& f : faces) text += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
  return text;
}

/// A file with +Z up whose root turns it: the places of the world are (x, z, -y).
std::string gltf(double3 at) {
  std::string data, digits;
  const auto add = [&](const auto& value) { data.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const double3 c : corners) add(narrowed(c));
  for (const auto& f : faces)
    for (const int i : f) add(static_cast<std::uint16_t>(i));
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < data.size(); i += 3) {  // 96 bytes
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | static_cast<std::uint8_t>(data[i + k]);
    for (int shift = 18; shift >= 0; shift -= 6) digits += alphabet[word >> shift & 63];
  }
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[
{{"rotation":[-0.7071067811865475,0,0,0.7071067811865476],"children":[1]}},{{"mesh":0,"translation":[{},{},{}]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"buffers":[{{"byteLength":96,"uri":"data:;base64,{}"}}],
"bufferViews":[{{"buffer":0,"byteLength":60}},{{"buffer":0,"byteOffset":60,"byteLength":36}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3","min":[0,0,0],"max":[1,1,0.7]}},
{{"bufferView":1,"componentType":5123,"count":18,"type":"SCALAR"}}]}})",
      at.x, at.y, at.z, digits);
}

std::string ascii_stl(double3 at) {
  std::string text = "solid pyramid\n";
  for (const auto& f : faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int i : f) {
      const double3 c = at + corners[static_cast<std::size_t>(i)];
      text += fmt::format("vertex {:.3f} {:.3f} {:.3f}\n", c.x, c.y, c.z);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

std::string mesh_3mf(double3 at) {
  std::string text = "<mesh><vertices>";
  for (const double3 c : corners)
    text += fmt::format(R"(<vertex x="{:.3f}" y="{:.3f}" z="{:.3f}"/>)", at.x + c.x, at.y + c.y, at.z + c.z);
  text += "</vertices><triangles>";
  for (const auto& f : faces) text += fmt::format(R"(<triangle v1="{}" v2="{}" v3="{}"/>)", f[0], f[1], f[2]);
  return text + "</triangles></mesh>";
}
std::string moved_by(double3 at) {
  return fmt::format(R"(transform="1 0 0 0 1 0 0 0 1 {:.3f} {:.3f} {:.3f}")", at.x, at.y, at.z);
}
std::string package_3mf(const std::string& objects, const std::string& build) {
  const std::vector<std::uint8_t> bytes = maker_3mf::package(maker_3mf::model(objects, build));
  return {bytes.begin(), bytes.end()};
}
std::string far_vertices_3mf(double3 at) { return package_3mf(maker_3mf::object(1, mesh_3mf(at)), maker_3mf::item(1)); }
/// The item moves an assembly by one part, which moves its component by the rest.
std::string far_transforms_3mf(double3 at) {
  const double3 item{at.x + 0.25, at.y - 1000, 7}, component = at - item;
  return package_3mf(maker_3mf::object(1, mesh_3mf({})) +
                         maker_3mf::object(2, fmt::format("<components><component objectid=\"1\" {}/></components>",
                                                          moved_by(component))),
                     maker_3mf::item(2, moved_by(item)));
}
/// Vertices far from the origin of an object that is moved back to that of the scene.
std::string moved_back_3mf(double3 at) {
  return package_3mf(maker_3mf::object(1, mesh_3mf(at)), maker_3mf::item(1, moved_by(double3{} - at)));
}

std::string object_amf(double3 at) {
  std::string text = "<object id=\"1\"><mesh><vertices>";
  for (const double3 c : corners)
    text += fmt::format("<vertex><coordinates><x>{:.3f}</x><y>{:.3f}</y><z>{:.3f}</z></coordinates></vertex>",
                        at.x + c.x, at.y + c.y, at.z + c.z);
  text += "</vertices><volume>";
  for (const auto& f : faces)
    text += fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>", f[0], f[1], f[2]);
  return text + "</volume></mesh></object>";
}
std::string far_vertices_amf(double3 at) { return "<amf>" + object_amf(at) + "</amf>"; }
std::string far_transform_amf(double3 at) {
  return "<amf>" + object_amf({}) +
         fmt::format(
             "<constellation id=\"2\"><instance objectid=\"1\"><deltax>{:.3f}</deltax><deltay>{:.3f}</deltay>"
             "<deltaz>{:.3f}</deltaz></instance></constellation></amf>",
             at.x, at.y, at.z);
}

/// The text with `more` before the first `what`.
std::string with(std::string text, std::string_view what, std::string_view more) {
  return text.insert(text.find(what), more);
}
// Files whose last vertex, at 0, belongs to no triangle.
std::string stray_ply(double3 at) {
  std::string text = with(ascii_ply(at), "3 0 2 1", "0 0 0\n");
  return text.replace(text.find("vertex 5"), 8, "vertex 6");
}
std::string stray_obj(double3 at) { return obj(at) + "v 0 0 0\n"; }
std::string stray_3mf(double3 at) {
  return package_3mf(maker_3mf::object(1, with(mesh_3mf(at), "</vertices>", R"(<vertex x="0" y="0" z="0"/>)")),
                     maker_3mf::item(1));
}
std::string stray_amf(double3 at) {
  return with(far_vertices_amf(at), "</vertices>",
              "<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>");
}

class FarScenes : public testing::Test {
 protected:
  FarScenes() : place_(fs::temp_directory_path() / ("zoneplate_far_" + std::to_string(::getpid()))) {
    fs::create_directories(place_);
  }
  ~FarScenes() override { fs::remove_all(place_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(place_ / name, std::ios::binary) << text;
  }
  int run(const std::string& words) const {
    return std::system(("cd " + place_.string() + " && " + program_file + " " + words + " > said 2>&1").c_str());
  }
  std::string file(const std::string& name) const {
    const FileBytes bytes((place_ / name).string());
    return {reinterpret_cast<const char*>(bytes.bytes().data()), bytes.bytes().size()};
  }
  /// Renders near.EXTENSION and far.EXTENSION with options; expects equal images.
  void expect_equal(const std::string& extension, const std::string& near_options, const std::string& far_options) {
    ASSERT_EQ(run("near" + extension + " -o near.png --size 96x96 " + near_options), 0) << file("said");
    ASSERT_EQ(run("far" + extension + " -o far.png --size 96x96 " + far_options), 0) << file("said");
    EXPECT_EQ(run("metrics near.png far.png --metric psnr --threshold 60"), 0) << extension << ' ' << file("said");
  }

 private:
  fs::path place_;
};

constexpr std::array<double3, 5> places = {{{1e4, 1e4, 100},
                                            {1e5, 1e5, 100},
                                            {1e6, 1e6, 100},
                                            {500000.1, 5200000.1, 300.1},
                                            {4200000.3, 120000.7, 4780000.9}}};

TEST_F(FarScenes, LookAsNearTheOrigin) {
  struct Format {
    std::string extension;
    std::string (*text)(double3);
  };
  for (const Format& format : {Format{".ply", ascii_ply},
                               {".obj", obj},
                               {".gltf", gltf},
                               {".stl", ascii_stl},
                               {".3mf", far_vertices_3mf},
                               {".3mf", far_transforms_3mf},
                               {".3mf", moved_back_3mf},
                               {".amf", far_vertices_amf},
                               {".amf", far_transform_amf},
                               {".ply", stray_ply},
                               {".obj", stray_obj},
                               {".3mf", stray_3mf},
                               {".amf", stray_amf}}) {
    write("near" + format.extension, format.text({}));
    for (const double3 at : places) {
      write("far" + format.extension, format.text(at));
      expect_equal(format.extension, "", "");
    }
    expect_equal(format.extension, "--up +Z --aa ssaa:n=2 --shadows soft", "--up +Z --aa ssaa:n=2 --shadows soft");
  }
}

TEST_F(FarScenes, OptionsAndInfoHaveTheCoordinatesOfTheFile) {
  write("near.obj", obj({}));
  write("far.obj", obj({500000.125, 5200000.25, 300.5}));
  expect_equal(".obj", "--camera-position 2,-1.5,1.7 --camera-focal-point 0.5,0.4,0.3",
               "--camera-position 500002.125,5199998.75,302.2 --camera-focal-point 500000.625,5200000.65,300.8");
  ASSERT_EQ(run("info far.obj"), 0);
  EXPECT_NE(file("said").find("500000.125, 5200000.25, 300.5  to  500001.125, 5200001.25, 301.2"), std::string::npos)
      << file("said");
}

/// The matrix of an attribute of an EXR file, which multiplies row vectors.
std::array<float, 16> matrix_of(const std::string& file, const std::string& name) {
  const std::string head = name + '\0' + "m44f" + '\0';
  std::array<float, 16> out{};
  const std::size_t at = file.find(head);
  EXPECT_NE(at, file.npos) << name;
  if (at != file.npos) std::memcpy(out.data(), file.data() + at + head.size() + 4, sizeof out);
  return out;
}

TEST_F(FarScenes, ExrHeadersHaveTheCoordinatesOfTheFile) {
  constexpr double3 at{10000, 20000, 100};
  write("near.obj", obj({}));
  write("far.obj", obj(at));
  for (const char* name : {"near", "far"})
    ASSERT_EQ(run(fmt::format("{0}.obj -o {0}.exr --size 96x96 --aov position", name)), 0) << file("said");
  for (const char* name : {"worldToCamera", "worldToNDC"}) {
    const auto near = matrix_of(file("near.exr"), name), far = matrix_of(file("far.exr"), name);
    for (std::size_t column = 0; column < 4; ++column) {
      const auto image = [&](const std::array<float, 16>& m, double3 p) {
        return p.x * m[column] + p.y * m[4 + column] + p.z * m[8 + column] + double{m[12 + column]};
      };
      EXPECT_NEAR(image(far, at + corners[4]), image(near, corners[4]), 0.01) << name;
    }
  }
  EXPECT_NE(file("far.exr").find("multiples of 0.001953125 at 20000"), std::string::npos);
  EXPECT_EQ(file("near.exr").find("multiples of"), std::string::npos);
}

}  // namespace
}  // namespace zoneplate
