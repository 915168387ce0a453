// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/import_budget.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>
#include <string>

#include "zoneplate/base/deadline.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/formats/import/colliding_for_test.h"
#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/mesh_samples_for_test.h"
#include "zoneplate/formats/obj/chunk.h"
#include "zoneplate/formats/obj/obj.h"
#include "zoneplate/formats/ply/ply.h"
#include "zoneplate/formats/stl/stl.h"
#include "zoneplate/formats/stl/text.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr int knots = 100, budget_corners = 4096, points = 256;

/// A corner of an outline with very many self-intersections, which is a worst case of triangulation.
std::uint32_t knot_corner(int i) { return hash(static_cast<std::uint32_t>(i)) % points; }

std::string place(std::uint32_t point) {
  return std::to_string(hash(point, 1) % 1000) + " " + std::to_string(hash(point, 2) % 1000) + " 0\n";
}

std::string ply_of_knots() {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(knots) +
                     "\nproperty list uint uint vertex_indices\nend_header\n";
  for (std::uint32_t p = 0; p < points; ++p) text += place(p);
  for (int k = 0; k < knots; ++k) {
    text += std::to_string(budget_corners);
    for (int i = 0; i < budget_corners; ++i) text += " " + std::to_string(knot_corner(i));
    text += "\n";
  }
  return text;
}

std::string obj_of_knots() {
  std::string text;
  for (std::uint32_t p = 0; p < points; ++p) text += "v " + place(p);
  for (int k = 0; k < knots; ++k) {
    text += "f";
    for (int i = 0; i < budget_corners; ++i) text += " " + std::to_string(1 + knot_corner(i));
    text += "\n";
  }
  return text;
}

std::string stl_of_knots() {
  std::string text = "solid knots\n";
  for (int k = 0; k < knots; ++k) {
    text += "facet normal 0 0 1 outer loop\n";
    for (int i = 0; i < budget_corners; ++i) text += "vertex " + place(knot_corner(i));
    text += "endloop endfacet\n";
  }
  return text;
}

/// Loads a text of knots, which takes much longer than the time limit, and returns the error message.
template <class Load>
std::string hurried(const Load& load, const std::string& text) {
  const MemoryFile file;
  const std::string path = file.write({text.begin(), text.end()});
  const std::clock_t begin = std::clock();
  std::string message = "loaded";
  try {
    load(path, {.seconds = 0.1});
  } catch (const Error& error) {
    message = error.what();
  }
  // A knot takes some tenths of a second, and all knots many times this bound; threads may finish a few knots after the
  // time limit.
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 4.0);
  return message.substr(std::min(message.size(), path.size()));
}

TEST(ImportBudget, TimeRunsOutBetweenTheFacesOfABlock) {
  const std::string late = ": takes longer to load than the limit of 100 ms (--max-import-seconds)";
  EXPECT_EQ(hurried(load_obj, obj_of_knots()), late);
  EXPECT_EQ(hurried(load_ply, ply_of_knots()), late);
  EXPECT_EQ(hurried(load_stl, stl_of_knots()), late);
}

/// The error message of a loader that starts after its deadline.
template <class Load>
std::string late(const Load& load, const std::string& path) {
  try {
    with_deadline(0, ErrorKind::Failed, "the time is up", [&] { load(path, LoadLimits{}); });
  } catch (const Error& error) {
    return error.what();
  }
  return "loaded";
}

TEST(ImportBudget, DeadlinesHoldForReadersOfEveryFormat) {
  const MemoryFile file;
  using mesh_samples::bytes_of;
  const auto glb = [](const std::string& path, const LoadLimits& limits) { return load_gltf(path, limits); };
  EXPECT_EQ(late(load_obj, file.write(bytes_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"))), "the time is up");
  EXPECT_EQ(late(load_ply, file.write(mesh_samples::binary_ply(false))), "the time is up");
  EXPECT_EQ(late(load_ply, file.write(bytes_of(mesh_samples::ascii_ply))), "the time is up");
  EXPECT_EQ(late(load_stl, file.write(mesh_samples::binary_stl())), "the time is up");
  EXPECT_EQ(late(load_stl, file.write(bytes_of(mesh_samples::ascii_stl))), "the time is up");
  EXPECT_EQ(late(glb, file.write(triangle_maker().glb())), "the time is up");
}

/// Loads a text; returns the processor time in seconds.
template <class Load>
double seconds_of(const Load& load, const std::string& text, Scene& scene) {
  const MemoryFile file;
  const std::string path = file.write({text.begin(), text.end()});
  const std::clock_t begin = std::clock();
  scene = load(path, LoadLimits{});
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// The bound separates two far-apart times: without the protection, each line is compared with 10^4 others.
constexpr double generous = 20;

const std::string single_triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(ImportBudget, PositionsThatCollideTakeTheTimeOfOthers) {
  std::string text;
  int vertices = 0;
  for (std::uint32_t i = 0; vertices < 99999; ++i) {
    const std::uint32_t y = 0x3f800000 + i, z = 0x40000000;
    const float x = std::bit_cast<float>(colliding_word(0, y, z, 0));
    if (!std::isfinite(x)) continue;
    text += fmt::format("v {:.9g} {:.9g} 2\n", x, std::bit_cast<float>(y));
    ++vertices;
  }
  for (int i = 1; i <= vertices; i += 3) text += fmt::format("f {} {} {}\n", i, i + 1, i + 2);
  Scene scene;
  EXPECT_LT(seconds_of(load_obj, text, scene), generous);  // an open-addressing table would take 5 * 10^9 steps
  EXPECT_EQ(scene.meshes.at(0).position.size(), 99999u);
}

TEST(ImportBudget, VeryManyNamesTakeLinearTime) {
  const std::string long_name(100000, 'n');
  std::string text = "o " + long_name + "\n" + single_triangle;
  for (int i = 0; i < 40000; ++i) text += fmt::format("s {}\nf 1 2 3\n", i);
  Scene scene;
  // The object's name is looked up once, not once per smoothing group.
  EXPECT_LT(seconds_of(load_obj, text, scene), generous);
  EXPECT_EQ(scene.objects, NameList{long_name});

  text = single_triangle;
  for (int i = 0; i < 20000; ++i) text += fmt::format("usemtl m{}\nf 1 2 3\n", i);
  EXPECT_LT(seconds_of(load_obj, text, scene), generous);
  EXPECT_EQ(scene.meshes.size(), 20001u);
}

TEST(ImportBudget, LibrariesAreLookedForAThousandTimes) {
  std::string text = single_triangle + "mtllib";
  for (int i = 0; i < 500; ++i) text += fmt::format(" none{}", i);
  for (int i = 0; i < 100000; ++i) text += fmt::format("\nmtllib none{}.mtl", i);
  Scene scene;
  EXPECT_LT(seconds_of(load_obj, text + "\n", scene), generous);
  const auto is_it = [](const std::string& w) { return w.find("more than 1000 material libraries") != w.npos; };
  EXPECT_TRUE(std::any_of(scene.warnings.begin(), scene.warnings.end(), is_it));
  EXPECT_LT(scene.warnings.size(), 30u);
}

TEST(ImportBudget, EmptyLinesAndSolidsTakeLinearTime) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  Scene scene;
  EXPECT_LT(seconds_of(load_stl, "solid a\n" + facet + std::string(3000000, '\n') + facet, scene), generous);
  EXPECT_EQ(scene.meshes.at(0).primitives(), 2u);

  std::string text;
  for (int i = 0; i < 100000; ++i) text += "solid none\nendsolid none\n";
  EXPECT_LT(seconds_of(load_stl, text + "solid some\n" + facet, scene), generous);
  EXPECT_EQ(scene.objects, NameList{"some"});
  ImportBudget budget("file", {.memory = 4 << 20});
  EXPECT_LE(parse_stl_text(text, budget).solids.size(), 1u);
}

/// Of the state changes between two elements, the last of each kind is kept; the others take no memory.
TEST(ImportBudget, NamesOfNothingTakeNoRoom) {
  std::string text = single_triangle;
  for (int i = 0; i < 1000; ++i) text += "o a\ng b\nusemtl c\ns 1\n";
  ObjPart part;
  ASSERT_TRUE(read_obj_part(text + "o last\nf 1 2 3\n", '\n', part));
  ASSERT_EQ(part.chunk.states.size(), 4u);
  EXPECT_EQ(part.chunk.states[0].text, "last");
  EXPECT_EQ(part.chunk.states[2].text, "c");
}

}  // namespace
}  // namespace zoneplate
