// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/stream/stream.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "zoneplate/formats/gltf/load_for_test.h"
#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/stream_for_test.h"

namespace zoneplate {
namespace {

constexpr std::uint32_t side = 20, vertices = (side + 1) * (side + 1), corners = 6 * side * side;

std::vector<float> random_floats(std::size_t count, std::uint32_t seed) {
  std::vector<float> out;
  for (std::uint32_t i = 0; i < count; ++i) out.push_back(unit_float(hash(i, seed)) + 0.1f);
  return out;
}

/// The indices of a square of triangles, in a scattered order.
template <class T>
std::vector<T> grid_indices() {
  std::vector<T> out;
  for (std::uint32_t k = 0; k < side * side; ++k) {
    const std::uint32_t square = k * 7 % (side * side), a = square / side * (side + 1) + square % side;
    for (const std::uint32_t v : {a, a + 1, a + side + 1, a + side + 1, a + 1, a + side + 2})
      out.push_back(static_cast<T>(v));
  }
  return out;
}

/// Two meshes, of three primitives and of one, by four nodes: indices of 16 and 32 bits and none, normals and none,
/// bytes with a stride, colours, texture coordinates, a material and none.
GltfMaker patches() {
  GltfMaker m;
  const std::string position = m.floats("VEC3", random_floats(3 * vertices, 1));
  const std::string normal = m.floats("VEC3", random_floats(3 * vertices, 2));
  const std::string color = m.floats("VEC4", random_floats(4 * vertices, 3));
  const std::string uv = m.floats("VEC2", random_floats(2 * vertices, 4));
  const std::string shorts = m.values<std::uint16_t>("SCALAR", grid_indices<std::uint16_t>());
  const std::string words = m.values<std::uint32_t>("SCALAR", grid_indices<std::uint32_t>());
  std::vector<std::int8_t> bytes;
  for (std::uint32_t i = 0; i < 4 * vertices; ++i) bytes.push_back(static_cast<std::int8_t>(hash(i, 6) % 200));
  const std::string packed =
      m.accessor(fmt::format(R"({{"bufferView":{},"componentType":5120,"normalized":true,"count":{},"type":"VEC3"}})",
                             m.view(bytes, 4), vertices));
  const std::string loose = m.floats("VEC3", random_floats(31 * 3, 7));
  const std::string few = m.floats("VEC3", random_floats(30 * 3, 8));
  const auto primitive = [](const std::string& attributes, const std::string& more) {
    return R"({"attributes":{)" + attributes + "}" + more + "}";
  };
  m.meshes = fmt::format(
      R"({{"name":"a","primitives":[{},{},{}]}},{{"primitives":[{}]}})",
      primitive(fmt::format(R"("POSITION":{},"NORMAL":{},"COLOR_0":{},"TEXCOORD_0":{})", position, normal, color, uv),
                fmt::format(R"(,"indices":{},"material":1)", shorts)),
      primitive(fmt::format(R"("POSITION":{})", position), fmt::format(R"(,"indices":{},"material":0)", words)),
      primitive(fmt::format(R"("POSITION":{},"NORMAL":{})", loose, few), ""),
      primitive(fmt::format(R"("POSITION":{},"NORMAL":{})", packed, normal), fmt::format(R"(,"indices":{})", words)));
  m.materials = R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}},{"doubleSided":true})";
  m.nodes = R"({"mesh":0},{"mesh":1,"translation":[3,0,0],"rotation":[0,0.6,0,0.8]},{"name":"turned","scale":[-1,2,1],
    "mesh":0,"children":[3]},{"mesh":1,"scale":[0,0,0]})";
  m.scene_nodes = "0,1,2";
  m.rest = R"(,"extensionsUsed":["KHR_mesh_quantization"])";
  return m;
}

TEST(GltfStream, HasTheSceneOfTheLoader) {
  const TestFolder folder;
  const GltfMaker m = patches();
  folder.write("f.bin", m.binary);
  for (const std::string& path :
       {folder.write("f.glb", m.glb()), folder.write("f.gltf", m.json(R"(,"uri":"f.bin")"))}) {
    const std::unique_ptr<FileStream> stream = open_gltf_stream(path, {});
    ASSERT_TRUE(stream);
    EXPECT_EQ(stream->instances().size(), 7u);
    EXPECT_EQ(stream->count(), 5 * corners / 3 + 2 * 31 / 3);
    expect_scene_of(*stream, path, load_gltf(path), 0.1f);
    EXPECT_EQ(stream->head().warnings, load_gltf(path).warnings);
  }
}

TEST(GltfStream, KnowsByItsJsonWhetherItMayFit) {
  const TestFolder folder;
  const std::string path = folder.write("f.glb", patches().glb());
  EXPECT_FALSE(gltf_may_exceed_memory(path, {.memory = 1 << 20}, {}));
  EXPECT_TRUE(gltf_may_exceed_memory(path, {.memory = 1 << 19}, {}));
  const std::uint64_t least = open_gltf_stream(path, {})->bytes_in_memory();
  EXPECT_GT(least, std::uint64_t{vertices} * 60 + corners * 60);
  EXPECT_LT(least, 300'000u);
}

/// A triangle with more in its primitive, its mesh and its file.
struct Variant {
  const char* cause;  ///< empty: it is read in parts
  std::string primitive, mesh, materials, nodes, rest;
};

TEST(GltfStream, RefusesByNameWhatDependsOnTheWhole) {
  const TestFolder folder;
  const Variant variants[] = {
      {.cause = "", .primitive = R"(,"material":0)", .materials = R"({"alphaMode":"OPAQUE"})"},
      {.cause = "strips, fans, lines or points", .primitive = R"(,"mode":5)"},
      {.cause = "morph targets", .primitive = R"(,"targets":[{"POSITION":0}])", .mesh = R"(,"weights":[1])"},
      {.cause = "Draco", .primitive = R"(,"extensions":{"KHR_draco_mesh_compression":{}})"},
      {.cause = "skins", .nodes = R"({"mesh":0,"skin":0})", .rest = R"(,"skins":[{"joints":[0]}])"},
      {.cause = "far from the origin", .nodes = R"({"mesh":0,"translation":[1e6,0,0]})"},
  };
  for (const Variant& v : variants) {
    SCOPED_TRACE(v.cause + v.primitive);
    GltfMaker m;
    const std::string position =
        m.values<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, R"(,"min":[0,0,0],"max":[1,1,0])");
    m.meshes = R"({"primitives":[{"attributes":{"POSITION":)" + position + "}" + v.primitive + "}]" + v.mesh + "}";
    m.materials = v.materials, m.nodes = v.nodes, m.rest = v.rest;
    const std::unique_ptr<FileStream> stream = open_gltf_stream(folder.write("f.glb", m.glb()), {});
    ASSERT_TRUE(stream);
    std::string cause;
    try {
      stream->check();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      cause = error.what();
    }
    EXPECT_EQ(cause.empty(), *v.cause == 0) << cause;
    EXPECT_NE(cause.find(v.cause), cause.npos) << cause;
  }
}

TEST(GltfStream, RefusesNormalsThatDependOnOtherTriangles) {
  const TestFolder folder;
  GltfMaker m;
  const std::string position = m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  m.mesh("\"POSITION\":" + position + ",\"NORMAL\":" + m.floats("VEC3", {0, 0, 1, 0, 0, 0, 0, 0, 1}));
  const std::string path = folder.write("f.glb", m.glb());
  const std::unique_ptr<FileStream> stream = open_gltf_stream(path, {});
  const StreamOutline outline(*stream, path, {});
  EXPECT_THROW(stream->head(), Error);
}

TEST(GltfStream, ReportsAFileThatIsChanged) {
  const MemoryFile file;
  GltfMaker m = patches();
  std::vector<std::uint8_t> bytes = m.glb();
  const std::string path = file.write(bytes);
  const std::unique_ptr<FileStream> stream = open_gltf_stream(path, {});
  const StreamOutline outline(*stream, path, {});
  const std::uint32_t some[] = {3, 5};
  EXPECT_EQ(stream->mesh(some).primitives(), 2u);
  std::fill(bytes.end() - static_cast<std::ptrdiff_t>(m.binary.size()), bytes.end(), std::uint8_t{0xff});
  file.write(bytes);
  EXPECT_THROW(stream->mesh(some), Error);
}

TEST(GltfStream, AgreesWithTheLoaderAboutDamagedFiles) {
  const std::vector<std::uint8_t> good = patches().glb();
  DamagedFiles files;
  for (std::uint32_t seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE(seed);
    std::vector<std::uint8_t> bytes = good;
    const std::size_t json = 20 + std::size_t{bytes[12]} + 256 * std::size_t{bytes[13]};
    for (std::uint32_t k = 0; k <= seed % 3; ++k)
      bytes[hash(seed, k) % (seed % 2 == 0 ? json : bytes.size())] = static_cast<std::uint8_t>(hash(seed, k, 1));
    if (seed % 50 == 7) bytes.resize(hash(seed, 9) % bytes.size());
    const MemoryFile file;
    const std::string path = file.write(bytes);
    files.add(
        path, [](const std::string& of) { return open_gltf_stream(of, {.memory = 1 << 24}); },
        [](const std::string& of) { return load_gltf(of); }, 0.02f);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(files.agreed, 100);
  EXPECT_GT(files.refused, 100);
}

}  // namespace
}  // namespace zoneplate
