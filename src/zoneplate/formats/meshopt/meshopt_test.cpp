// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/meshopt/meshopt.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <random>

#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/formats/import/damage_for_test.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A file with a row of `n` triangles whose positions and indices are both compressed.
Bytes packed_glb(std::uint32_t n) {
  std::vector<float3> position;
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto x = static_cast<float>(i);
    for (const float3 p : {float3{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}}) position.push_back(p);
    for (std::uint32_t k = 0; k < 3; ++k) index.push_back(3 * i + k);
  }
  Bytes vertices(meshopt_encodeVertexBufferBound(position.size(), 12)),
      order(meshopt_encodeIndexBufferBound(index.size(), position.size()));
  vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), position.data(), position.size(), 12));
  order.resize(meshopt_encodeIndexBuffer(order.data(), order.size(), index.data(), index.size()));

  GltfMaker m;
  const auto view = [&](const Bytes& bytes, std::size_t count, int stride, const char* mode) {
    while (m.binary.size() % 4 != 0) m.binary.push_back(0);
    m.views += (m.views.empty() ? "" : ",") + std::string(R"({"buffer":1,"byteLength":)") +
               std::to_string(count * static_cast<std::size_t>(stride)) +
               R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,"byteOffset":)" +
               std::to_string(m.binary.size()) + R"(,"byteLength":)" + std::to_string(bytes.size()) +
               R"(,"byteStride":)" + std::to_string(stride) + R"(,"count":)" + std::to_string(count) + R"(,"mode":")" +
               mode + "\"}}}";
    m.binary.insert(m.binary.end(), bytes.begin(), bytes.end());
  };
  view(vertices, position.size(), 12, "ATTRIBUTES");
  view(order, index.size(), 4, "TRIANGLES");
  const std::string count = std::to_string(position.size());
  m.accessor(R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":)" + count + "}");
  m.accessor(R"({"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" + count + "}");
  m.mesh(R"("POSITION":0)", R"(,"indices":1)");
  m.rest = R"(,"extensionsUsed":["EXT_meshopt_compression"],"extensionsRequired":["EXT_meshopt_compression"])";
  return m.glb();
}

TEST(GltfMeshopt, UnpacksVerticesAndTriangles) {
  const MemoryFile file;
  const Scene s = load_gltf(file.write(packed_glb(50)));
  ASSERT_EQ(s.meshes.size(), 1u);
  EXPECT_EQ(s.meshes[0].primitives(), 50u);
  EXPECT_EQ(s.bounds().high, (float3{50, 1, 0}));
  EXPECT_TRUE(s.warnings.empty());
}

TEST(GltfMeshopt, AnyByteChanged) {
  const Bytes good = packed_glb(20);
  const MemoryFile file;
  std::mt19937 random(1);
  int refused = 0;
  const auto load = [](const std::string& path, const LoadLimits& limits) { return load_gltf(path, limits); };
  for (int i = 0; i < 1500; ++i) {
    Bytes bytes = good;
    for (auto n = 1 + random() % 3; n > 0; --n) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    refused += load_soundly(load, file.write(bytes)) != "";
    if (testing::Test::HasFatalFailure()) FAIL() << "case " << i;
  }
  EXPECT_GT(refused, 100);
  EXPECT_LT(refused, 1500);
}

TEST(GltfMeshopt, Refusals) {
  const auto refusal = [](std::string from, const std::string& to) {
    Bytes bytes = packed_glb(4);
    std::string text(bytes.begin(), bytes.end());
    text.replace(text.find(from), from.size(), to);
    const MemoryFile file;
    const std::string path = file.write(Bytes(text.begin(), text.end()));
    const std::string error =
        load_soundly([](const std::string& p, const LoadLimits& limits) { return load_gltf(p, limits); }, path);
    return error.substr(error.find("bufferView"));
  };
  EXPECT_EQ(refusal("\"ATTRIBUTES\"", "\"ATTRIBUTE_\""),
            "bufferView 0 EXT_meshopt_compression: mode is 'ATTRIBUTE_', expected ATTRIBUTES, TRIANGLES or INDICES");
  EXPECT_EQ(refusal("\"byteStride\":4,", "\"byteStride\":8,"),
            "bufferView 1 EXT_meshopt_compression: byteStride is 8, which does not go with TRIANGLES and NONE");
}

}  // namespace
}  // namespace zoneplate
