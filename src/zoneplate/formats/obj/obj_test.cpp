// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/obj.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

/// A fixture with a temporary folder.
class ObjModel : public testing::Test {
 protected:
  ObjModel() : folder_(fs::temp_directory_path() / ("zoneplate_obj_" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "sub");
  }
  ~ObjModel() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  Scene load(const std::string& text, const LoadLimits& limits = {}) const {
    return load_obj(write("model.obj", text), limits);
  }
  /// The error message, without the folder's name.
  std::string refusal(const std::string& text, const LoadLimits& limits = {}) const {
    try {
      load(text, limits);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      return without_folder(error.what());
    }
    return "loaded";
  }
  std::string without_folder(std::string text) const {
    const std::string prefix = folder_.string() + "/";
    for (std::size_t at = text.find(prefix); at != text.npos; at = text.find(prefix)) text.erase(at, prefix.size());
    return text;
  }
  std::string warnings_of(const Scene& scene) const {
    std::string all;
    for (const std::string& w : scene.warnings) all += without_folder(w) + "\n";
    return all;
  }

  fs::path folder_;
};

const std::string square_text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(ObjModel, ReadsEveryFormOfIndices) {
  const std::string attributes = square_text + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 2\n";
  const std::vector<float3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<std::uint32_t> two = {0, 1, 2, 0, 2, 3};
  for (const char* face : {"f 1/1/1 2/2/1 3/3/1 4/4/1", "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1",
                           "f 1/-4/1 -3/2/-1 3/3/1 4/4/1", "f  1/1/1\t2/2/1 \\\n 3/3/1 4/4/1 \r"}) {
    const Mesh mesh = load(attributes + face).meshes.at(0);
    EXPECT_EQ(mesh.position, corners) << face;
    EXPECT_EQ(mesh.index, two);
    EXPECT_EQ(mesh.normal, (std::vector<float3>(4, {0, 0, 1})));
    EXPECT_EQ(mesh.uv0, (std::vector<float2>{{0, 1}, {1, 1}, {1, 0}, {0, 0}}));  // v is flipped
  }
  const Mesh bare = load(attributes + "f 1 2 3 4").meshes.at(0);
  EXPECT_TRUE(bare.uv0.empty());
  EXPECT_EQ(bare.normal, (std::vector<float3>(4, {0, 0, 1})));
  EXPECT_TRUE(load(attributes + "f 1//1 2//1 3//1").meshes.at(0).uv0.empty());
  EXPECT_EQ(load(attributes + "f 1/1 2/2 3/3").meshes.at(0).uv0.size(), 3u);
}

TEST_F(ObjModel, IndicesMayComeBeforeTheirVertices) {
  EXPECT_EQ(load("f 1 2 3\n" + square_text).meshes.at(0).primitives(), 1u);
}

TEST_F(ObjModel, ReadsLinesOfEveryKind) {
  for (const char* text :
       {"\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", "# x\n\n \t\nv 0 0 0 # a\nv 1\\\n0 \\\n 0\nv 0 1 0\nf 1 2 3"})
    EXPECT_EQ(load(text).meshes.at(0).primitives(), 1u) << text;
}

TEST_F(ObjModel, SharesVerticesInTheOrderOfFirstUse) {
  const Mesh mesh =
      load(square_text + "v 5 5 5\nvt 0 0\nvt 1 1\nf 4/1 1/1 2/1\nf 4/1 2/1 3/1\nf 1/2 2/1 3/1\n").meshes.at(0);
  EXPECT_EQ(mesh.index, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 4, 2, 3}));
  EXPECT_EQ(mesh.position.size(), 5u);
  EXPECT_EQ(mesh.position[4], mesh.position[1]);
}

TEST_F(ObjModel, SharesVerticesWhereOnePositionHasManyTextureCoordinates) {
  // Thousands of vertices at one position, each used three times: more than the hash of nearby vertices can separate.
  std::string text = square_text;
  for (int i = 0; i < 3000; ++i) text += "vt " + std::to_string(i) + " 0\n";
  for (int round = 0; round < 3; ++round)
    for (int i = 1; i <= 3000; ++i) text += "f 1/" + std::to_string(i) + " 2/1 3/1\n";
  const Mesh mesh = load(text).meshes.at(0);
  EXPECT_EQ(mesh.position.size(), 3002u);
  EXPECT_EQ(mesh.primitives(), 9000u);
  for (std::size_t i = 0; i < mesh.index.size(); i += 3)
    ASSERT_EQ(mesh.uv0[mesh.index[i]].x, static_cast<float>(i / 3 % 3000));
}

TEST_F(ObjModel, MakesAMeshForEachMaterialOfEachObject) {
  const Scene scene = load(square_text +
                           "f 1 2 3\no a\ng left\nusemtl red\nf 1 2 3\ng right\nf 1 3 4\nusemtl blue\nf 1 2 4\n"
                           "o b\nusemtl red\nf 2 3 4\nl 1 2 3\no a\nf 1 2 3\no empty\n");
  EXPECT_EQ(scene.objects, (std::vector<std::string>{"model", "a", "b"}));
  ASSERT_EQ(scene.meshes.size(), 5u);
  const auto check = [&](std::size_t i, int object, const char* material, std::size_t primitives, Topology topology) {
    const Mesh& mesh = scene.meshes[i];
    EXPECT_EQ(scene.instances[i].object, object);
    EXPECT_EQ(scene.materials[static_cast<std::size_t>(mesh.material)].name, material);
    EXPECT_EQ(mesh.primitives(), primitives);
    EXPECT_EQ(mesh.topology, topology);
  };
  check(0, 0, "default", 1, Topology::Triangles);
  check(1, 1, "red", 3, Topology::Triangles);  // both groups, and the elements after the object statement is repeated
  check(2, 1, "blue", 1, Topology::Triangles);
  check(3, 2, "red", 1, Topology::Triangles);
  check(4, 2, "red", 2, Topology::Lines);
  EXPECT_EQ(warnings_of(scene), "model.obj: material red is not defined\nmodel.obj: material blue is not defined\n");
  EXPECT_TRUE(scene.meshes[4].normal.empty());

  // Without any `o`, groups become the objects.
  EXPECT_EQ(load(square_text + "g left side\nf 1 2 3\ng right\nf 1 3 4\n").objects,
            (std::vector<std::string>{"left side", "right"}));
}

TEST_F(ObjModel, ReadsPointsAndLinesAndClouds) {
  const Scene scene = load(square_text + "p 1 2\np -1\nl 1 2 3 4\n");
  EXPECT_EQ(scene.meshes.at(0).topology, Topology::Points);
  EXPECT_EQ(scene.meshes[0].index, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(scene.meshes.at(1).topology, Topology::Lines);
  EXPECT_EQ(scene.meshes[1].index, (std::vector<std::uint32_t>{0, 1, 1, 2, 2, 3}));
  const Scene cloud = load(square_text);
  EXPECT_EQ(cloud.meshes.at(0).topology, Topology::Points);
  EXPECT_EQ(cloud.meshes[0].primitives(), 4u);
}

TEST_F(ObjModel, ReadsVertexColours) {
  const Mesh mesh = load("v 0 0 0 1 0.5 0\nv 1 0 0 2 -1 1 0.25\nv 0 1 0\nv 0 0 1 1\nf 1 2 3 4\n").meshes.at(0);
  EXPECT_EQ(mesh.color,
            (std::vector<float4>{{1, decode_srgb(0.5f), 0, 1}, {1, 0, 1, 0.25f}, {1, 1, 1, 1}, {1, 1, 1, 1}}));
  EXPECT_TRUE(load(square_text + "f 1 2 3").meshes.at(0).color.empty());
  const Mesh odd = load("v 0 0 0 nan inf -inf nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").meshes.at(0);
  EXPECT_EQ(odd.color[0], (float4{0, 1, 0, 1}));
}

TEST_F(ObjModel, CutsConcavePolygonsRightly) {
  // An arrow, in which the fan from the first corner would leave the polygon.
  const Mesh mesh = load("v 0 2 0\nv -2 -1 0\nv 0 0 0\nv 2 -1 0\nf 2 3 4 1\n").meshes.at(0);
  float area = 0;
  for (std::size_t i = 0; i < mesh.index.size(); i += 3) {
    const auto p = [&](std::size_t k) { return mesh.position[mesh.index[i + k]]; };
    EXPECT_GT(cross(p(1) - p(0), p(2) - p(0)).z, 0);
    area += cross(p(1) - p(0), p(2) - p(0)).z / 2;
  }
  EXPECT_EQ(area, 4);
}

/// Two squares that meet at the z axis: one in the plane y = 0, the other rotated upwards by `bend`.
std::string folded(float bend) {
  const std::string c = std::to_string(std::cos(bend)), s = std::to_string(std::sin(bend));
  return "v 0 0 0\nv 0 0 1\nv -1 0 1\nv -1 0 0\nv " + c + " " + s + " 0\nv " + c + " " + s + " 1\n";
}
const std::string fold_left = "f 1 4 3 2\n", fold_right = "f 1 2 6 5\n";

TEST_F(ObjModel, SmoothsWithinAGroupOnly) {
  const std::string both = fold_left + fold_right;
  const auto shared = [&](const std::string& text) { return load(text).meshes.at(0).position.size() == 6; };
  EXPECT_TRUE(shared(folded(1.4f) + "s 1\n" + both));
  EXPECT_TRUE(shared(folded(1.4f) + "s on\n" + both));
  EXPECT_FALSE(shared(folded(0.1f) + "s off\n" + both));
  EXPECT_FALSE(shared(folded(0.1f) + "s 0\n" + both));
  EXPECT_FALSE(shared(folded(0.1f) + "s 1\n" + fold_left + "s 2\n" + fold_right));
  // Smoothing is off before the first `s` of a file that has any.
  EXPECT_FALSE(shared(folded(0.1f) + fold_left + fold_right + "s 1\n"));
  // In a file without `s`, the angle decides: 50° is 0.873.
  EXPECT_TRUE(shared(folded(0.86f) + both));
  EXPECT_FALSE(shared(folded(0.88f) + both));

  const Mesh smooth = load(folded(1) + "s 7\n" + both).meshes.at(0);
  // Both faces have a right angle at the fold, so that the normal is the mean of theirs.
  const float3 mean = normalize(float3{0, 1, 0} + float3{-std::sin(1.0f), std::cos(1.0f), 0});
  EXPECT_NEAR(dot(smooth.normal[0], mean), 1, 1e-6f);
  const Mesh flat = load(folded(1) + "s off\n" + both).meshes.at(0);
  EXPECT_EQ(flat.normal[0], (float3{0, 1, 0}));
}

TEST_F(ObjModel, SmoothsByAngleNotByTriangles) {
  // At a cube's corner with one smoothing group, the normal is the diagonal, however the sides are triangulated.
  const Mesh mesh = load(
                        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\ns 1\n"
                        "f 5 6 7\nf 5 7 8\nf 2 3 7 6\nf 4 8 7 3\nf 1 5 8 4\nf 1 2 6 5\nf 1 4 3 2\n")
                        .meshes.at(0);
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    const float3 diagonal = normalize(mesh.position[i] - float3{0.5f, 0.5f, 0.5f});
    EXPECT_NEAR(dot(mesh.normal[i], diagonal), 1, 1e-6f);
  }
}

TEST_F(ObjModel, SmoothsAcrossVerticesAtOnePlace) {
  const Mesh mesh = load(
                        "v 0 0 0\nv 0 0 1\nv -1 0 1\nv -1 0 0\nv 1 0.5 0\nv 1 0.5 1\nv -0 0 0\nv 0 0 1\ns 1\n"
                        "f 1 4 3 2\nf 7 8 6 5\n")
                        .meshes.at(0);
  EXPECT_EQ(mesh.normal[0], mesh.normal[4]);
  EXPECT_NE(mesh.normal[0], (float3{0, 1, 0}));
}

TEST_F(ObjModel, AFanOfThousandsIsSmoothedInTime) {
  std::string text = "v 0 1 0\n";
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double a = 6.283185307179586 * i / n;
    text += "v " + std::to_string(std::cos(a)) + " 0 " + std::to_string(-std::sin(a)) + "\n";
  }
  for (int i = 0; i < n; ++i) text += "f 1 " + std::to_string(i + 2) + " " + std::to_string((i + 1) % n + 2) + "\n";
  const Mesh mesh = load(text).meshes.at(0);
  EXPECT_EQ(mesh.position.size(), n + 1u);
  EXPECT_NEAR(mesh.normal[0].y, 1, 1e-4f);
}

TEST_F(ObjModel, UsesNormalsThatAreThereAndMakesTheOthers) {
  const Mesh mesh = load(square_text + "vn 0 1 0\nvn 0 0 0\nvn nan 0 1\nf 1//1 2//2 3//3 4\n").meshes.at(0);
  EXPECT_EQ(mesh.normal, (std::vector<float3>{{0, 1, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}}));
}

TEST_F(ObjModel, DropsWhatIsNotFinite) {
  const Scene scene = load("v nan 0 0\nv 1.#IND 0 0\nv 1e99 0 0\n" + square_text +
                           "vt inf 0\nf 1 4 5\nf 2 4 5\nf 3 4 5\n" + "f 4/1 5/1 6/1\nl 1 4\np 2\n");
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].primitives(), 1u);
  EXPECT_EQ(warnings_of(scene),
            "model.obj: line 8: vt is not finite and set to 0\n"
            "model.obj: 5 faces, lines or points have a vertex that is not finite and are dropped\n");
}

TEST_F(ObjModel, SaysWhatIsWrongAndWhere) {
  const std::string nothing = " (4 vertices) is dropped; nothing is left that can be drawn";
  EXPECT_EQ(refusal(square_text + "f 1 2 99\n"), "model.obj: line 5: face with the corner '99'" + nothing);
  EXPECT_EQ(refusal(square_text + "\n\nf 1 2 0\n"), "model.obj: line 7: face with the corner '0'" + nothing);
  EXPECT_EQ(refusal(square_text + "f -5 \\\n1 2\n"), "model.obj: line 5: face with the corner '-5'" + nothing);
  EXPECT_EQ(refusal(square_text + "l 1 x\n"), "model.obj: line 5: line with the corner 'x'" + nothing);
  EXPECT_EQ(refusal(square_text + "f 1/2/3/4 2 3\n"), "model.obj: line 5: face with the corner '1/2/3/4'" + nothing);
  EXPECT_EQ(refusal("v 1 2\n"), "model.obj: line 1: vertex has 2 numbers, expected 3");
  EXPECT_EQ(refusal("v 1 2 3,5\n"), "model.obj: line 1: vertex: '3,5' is not a number");
  EXPECT_EQ(refusal(""), "model.obj: holds no faces, lines or points");
  EXPECT_EQ(
      refusal(square_text + "f 1\nf 1 2\n"),
      "model.obj: line 5: face has too few corners and is dropped (and 1 more); nothing is left that can be drawn");
  EXPECT_EQ(refusal("hello\n"), "model.obj: line 1: hello is unknown and ignored; nothing is left that can be drawn");
  EXPECT_EQ(refusal("f 99999999999999999999 1 1\n").substr(0, 60),
            "model.obj: line 1: face with the corner '9999999999999999999");
  try {
    load_obj((folder_ / "missing.obj").string());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
  }
}

// A file whose faces are cut into parts reads them twice: the counts of vertices that follow are known only then.
TEST_F(ObjModel, OneBadFaceDoesNotCostTheModel) {
  const Scene scene =
      load(square_text + "f 0 1 2\nf 1 2 3\nf 1 2 99\nf 1 x 3\nf 1x 2 3\nf 1// 2 /\nf -9 1 2\nf -4 -2 -1\n");
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].index, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(warnings_of(scene), "model.obj: line 5: face with the corner '0' (4 vertices) is dropped (and 5 more)\n");
}

TEST_F(ObjModel, NormalsDecideWhichSideIsOutside) {
  const std::string normal = "vn 0 0 1\n";
  const Scene counter = load(square_text + normal + "f 1//1 2//1 3//1 4//1\n");
  const Scene clockwise = load(square_text + normal + "f 4//1 3//1 2//1 1//1\n");
  for (const Scene* scene : {&counter, &clockwise}) {
    const Mesh& m = scene->meshes.at(0);
    for (std::size_t i = 0; i < m.index.size(); i += 3) {
      const float3 a = m.position[m.index[i]], b = m.position[m.index[i + 1]], c = m.position[m.index[i + 2]];
      EXPECT_GT(cross(b - a, c - a).z, 0);
    }
  }
}

TEST_F(ObjModel, NamesTextInUtf16) {
  EXPECT_EQ(refusal(std::string("\xff\xfev\0", 4)), "model.obj: is text in UTF-16, expected UTF-8 or ASCII");
  EXPECT_EQ(refusal(std::string("\xfe\xff\0v", 4)), "model.obj: is text in UTF-16, expected UTF-8 or ASCII");
}

TEST_F(ObjModel, WarnsOfWhatItPassesOver) {
  const Scene scene = load(square_text + "f 1 2 3\nf 1 2\nf 1//1 2//1 3//1\nf 1/7 2 3\ncurv 1 2\nfoo\nfoo\nlod 3\n");
  EXPECT_EQ(warnings_of(scene),
            "model.obj: line 6: face has too few corners and is dropped\n"
            "model.obj: line 9: curv is free-form geometry, which is not drawn\n"
            "model.obj: line 10: foo is unknown and ignored (and 1 more)\n"
            "model.obj: line 8: texture coordinate index out of range, treated as absent\n"
            "model.obj: line 7: normal index out of range, treated as absent (and 2 more)\n");
}

TEST_F(ObjModel, KeepsWithinItsLimits) {
  std::string text = square_text;
  for (int i = 0; i < 2000; ++i) text += "f 1 2 3\n";
  EXPECT_EQ(refusal(text, {.memory = 30000}), "model.obj: needs more than the limit of 29.3 kB (--max-memory)");
  EXPECT_EQ(refusal(text, {.memory = 100}).substr(0, 29), "model.obj: cannot be read: la");
  EXPECT_EQ(refusal(text, {.memory = 1 << 20}), "loaded");
}

/// A sheet of n × n squares, large enough that the file is cut into several chunks.
std::string sheet(int n) {
  std::string text;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x)
      text +=
          "v " + std::to_string(x) + " " + std::to_string((x * 7 + y * 3) % 5 * 0.1) + " " + std::to_string(y) + "\n";
    if (y == 0) continue;
    for (int x = 1; x <= n; ++x) {
      const int a = y * (n + 1) + x, b = -1 - x;
      text += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(b - n - 1) + " " +
              std::to_string(a - n - 1) + "\n";
    }
    if (y % 100 == 0) text += "usemtl m" + std::to_string(y / 100 % 3) + "\ns " + std::to_string(y / 100) + "\n";
  }
  return text;
}

bool same(const Mesh& a, const Mesh& b) {
  return a.position == b.position && a.normal == b.normal && a.uv0 == b.uv0 && a.index == b.index &&
         a.material == b.material;
}

TEST_F(ObjModel, IsTheSameForAnyNumberOfThreads) {
  const std::string path = write("sheet.obj", sheet(260));
  ASSERT_GT(fs::file_size(path), 2u << 20);
  Scene one, many;
  with_threads(1, [&] { one = load_obj(path); });
  with_threads(7, [&] { many = load_obj(path); });
  ASSERT_EQ(one.meshes.size(), many.meshes.size());
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < one.meshes.size(); ++i) {
    EXPECT_TRUE(same(one.meshes[i], many.meshes[i]));
    triangles += one.meshes[i].primitives();
  }
  EXPECT_EQ(triangles, 2u * 260 * 260);
}

TEST_F(ObjModel, TheFirstErrorOfManyIsReported) {
  std::string text = sheet(300);
  text.insert(text.find('\n', 2'500'000) + 1, "v x y z\n");
  text.insert(text.find('\n', 1'500'000) + 1, "v a b c\n");
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find("v a")), '\n') + 1;
  EXPECT_EQ(refusal(text), "model.obj: line " + std::to_string(line) + ": vertex: 'a' is not a number");
}

void expect_sound_shapes(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_LT(static_cast<std::size_t>(mesh.material), scene.materials.size());
    for (const float3 p : mesh.position) ASSERT_TRUE(is_finite(p));
    for (const float3 n : mesh.normal) ASSERT_NEAR(length(n), 1, 1e-4f);
    for (const float2 uv : mesh.uv0) ASSERT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y));
    for (const std::uint32_t i : mesh.index) ASSERT_LT(i, mesh.position.size());
    ASSERT_EQ(mesh.index.size() % static_cast<std::size_t>(mesh.vertices_per_primitive()), 0u);
  }
}

TEST_F(ObjModel, NamesCountAsMemory) {
  // Small files in which each line takes a hundred times its size in memory. Names without elements take none.
  const LoadLimits limits{.memory = 4 << 20};
  const auto lines = [](int count, const auto& line) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < count; ++i) text += line(std::to_string(i));
    return text;
  };
  const auto refused = [&](const std::string& text) { return refusal(text, limits).substr(0, 30); };
  const std::string over = "model.obj: needs more than the";
  EXPECT_EQ(refused("f 1 2 3\n" + lines(200000, [](const std::string& i) { return "o " + i + "\n"; })), "loaded");
  EXPECT_EQ(refused(lines(200000, [](const std::string&) { return "mtllib a\n"; })), over);
  EXPECT_EQ(refused(lines(10000, [](const std::string& i) { return "o " + i + "\nf 1 2 3\n"; })), over);
  EXPECT_EQ(refused(lines(10000, [](const std::string& i) { return "usemtl " + i + "\nf 1 2 3\n"; })), over);
  EXPECT_EQ(refusal(lines(1000, [](const std::string& i) { return "o " + i + "\nf 1 2 3\n"; }), limits), "loaded");
}

TEST_F(ObjModel, OfManyMaterialsThatAreNotDefinedSomeAreNamed) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 30; ++i) text += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
  const Scene scene = load(text);
  ASSERT_EQ(scene.warnings.size(), 21u);
  EXPECT_EQ(without_folder(scene.warnings[19]), "model.obj: material m19 is not defined");
  EXPECT_EQ(without_folder(scene.warnings[20]), "model.obj: 10 more materials are not defined");
}

TEST_F(ObjModel, MaterialsOfALibraryCountAsMemory) {
  std::string library;
  for (int i = 0; i < 20000; ++i) library += "newmtl " + std::to_string(i) + "\n";
  write("many.mtl", library);
  const std::string text = "mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl 7\nf 1 2 3\n";
  EXPECT_EQ(refusal(text, {.memory = 1 << 20}), "loaded");  // the file uses only one of the materials
  std::string all = "mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 20000; ++i) all += "usemtl " + std::to_string(i) + "\nf 1 2 3\n";
  EXPECT_EQ(refusal(all, {.memory = 32 << 20}).substr(0, 30), "model.obj: needs more than the");
  EXPECT_EQ(refusal(all), "loaded");
}

TEST_F(ObjModel, SurvivesAnyChange) {
  write("m.mtl", "newmtl red\nKd 1 0 0\nNs 20\nmap_Kd -s 2 2 x.png\nillum 2\n");
  const std::string text =
      "# a model\nmtllib m.mtl\no one\nv 0 0 0 1 1 1\nv 1 0 0\nv 1 1 1e3\nv 0 1 -0.5\nv 2 2 2\nvt 0 0\nvt 1 1\nvn 0 0 "
      "1\n"
      "usemtl red\ns 1\nf 1/1/1 2/2/1 3/1/1 4/2/1\nf -1 -2 -3\ng two\ns off\nf 1 2 3 4 5\\\n 1 3\nl 1 2 3\np 4 5\n";
  const std::string pieces = "0123456789-/.# \t\r\n\\eEfvlpogs\xff";
  const LoadLimits limits{.memory = 1 << 20, .seconds = 5};
  for (std::uint32_t seed = 0; seed < 4000; ++seed) {
    std::string changed = text;
    const std::uint32_t changes = 1 + hash(seed, 1) % 6;
    for (std::uint32_t i = 0; i < changes && !changed.empty(); ++i) {
      const std::size_t at = hash(seed, 2, i) % changed.size();
      const char piece = pieces[hash(seed, 3, i) % pieces.size()];
      switch (hash(seed, 4, i) % 5) {
        case 0:
          changed[at] = piece;
          break;
        case 1:
          changed.insert(at, 1 + hash(seed, 5, i) % 4, piece);
          break;
        case 2:
          changed.erase(at, 1 + hash(seed, 5, i) % 8);
          break;
        case 3:
          changed.insert(at, changed.substr(hash(seed, 5, i) % changed.size(), hash(seed, 6, i) % 20));
          break;
        default:
          changed.resize(at + 1);
      }
    }
    try {
      Scene scene;
      with_threads(1, [&] { scene = load(changed, limits); });
      expect_sound_shapes(scene);
    } catch (const Error& error) {
      ASSERT_EQ(error.kind(), ErrorKind::Input) << error.what();
    }
  }
}

std::size_t triangles_of(const Scene& scene) {
  std::size_t n = 0;
  for (const Mesh& mesh : scene.meshes) n += mesh.topology == Topology::Triangles ? mesh.primitives() : 0;
  return n;
}

class SharedObj : public testing::TestWithParam<std::string> {};
TEST_P(SharedObj, LoadsWithItsTriangles) {
  const Scene scene = load_obj(GetParam());
  expect_sound_shapes(scene);
  for (const auto& [name, triangles] :
       {std::pair{"spot_triangulated_good.obj", 5856u}, {"teapot.obj", 6320u}, {"suzanne.obj", 968u}})
    if (GetParam().ends_with(std::string("/") + name)) {
      EXPECT_EQ(triangles_of(scene), triangles);
    }
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedObj);
INSTANTIATE_TEST_SUITE_P(Obj, SharedObj, testing::ValuesIn(shared_files_ending("data/models/obj", {".obj"})));

class SharedInvalidObj : public testing::TestWithParam<std::string> {};
TEST_P(SharedInvalidObj, IsRefusedOrDrawnWithAWarning) {
  try {
    const Scene scene = load_obj(GetParam());
    expect_sound_shapes(scene);
    EXPECT_FALSE(scene.warnings.empty());
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
  }
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedInvalidObj);
INSTANTIATE_TEST_SUITE_P(Obj, SharedInvalidObj, testing::ValuesIn(shared_files_ending("data/invalid/obj", {".obj"})));

TEST_F(ObjModel, PositionsFarFromTheOriginKeepTheirPlaces) {
  // Several parts of the text, which are read in parallel; an unused vertex at 0, continued lines and colours.
  constexpr int count = 60000;
  std::string text = "v 0 0 0\n";
  for (int i = 0; i < count; ++i) {
    const double x = 500000.1 + 0.001 * i, y = 5200000.7 - 0.002 * i;
    text += i % 3 == 0   ? fmt::format("v {:.3f} {:.3f} 100.125\n", x, y)
            : i % 3 == 1 ? fmt::format("  v  {:.3f} \\\n {:.3f}  +1.00125e2 1 0 0\n", x, y)
                         : fmt::format("v\t{:.3f}\t{:.3f}\t100.125\r\n", x, y);
  }
  for (int i = 0; i + 2 < count; i += 3) text += fmt::format("f {} {} {}\n", i + 2, i + 3, i + 4);
  const Scene s = load(text);
  EXPECT_NE(s.origin, double3{});
  ASSERT_EQ(s.meshes.size(), 1u);
  ASSERT_EQ(s.meshes[0].position.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double3 p = s.in_file(s.meshes[0].position[static_cast<std::size_t>(i)]);
    ASSERT_NEAR(p.x, 500000.1 + 0.001 * i, 1e-5) << i;
    ASSERT_NEAR(p.y, 5200000.7 - 0.002 * i, 1e-5) << i;
    ASSERT_NEAR(p.z, 100.125, 1e-5) << i;
  }
}

TEST_F(ObjModel, PointsFarFromTheOriginKeepTheirPlaces) {
  const Scene s = load("v 4200000.01 120000.02 4780000.03\nv 4200000.02 120000.02 4780000.03\n");
  ASSERT_EQ(s.meshes[0].topology, Topology::Points);
  const float3 way = s.meshes[0].position[1] - s.meshes[0].position[0];
  EXPECT_NEAR(way.x, 0.01, 1e-7);
  EXPECT_EQ(load("v 40.01 12.02 47.03\nv 40.02 13.02 47.03\n").origin, double3{});
}

}  // namespace
}  // namespace zoneplate
