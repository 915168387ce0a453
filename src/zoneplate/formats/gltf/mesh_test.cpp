// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/mesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "zoneplate/formats/gltf/load_for_test.h"
#include "zoneplate/formats/gltf/maker_for_test.h"

namespace zoneplate {
namespace {

/// The corners of the unit square, (0,0) (1,0) (1,1) (0,1).
const std::vector<float> square_points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

TEST(GltfMesh, EveryAttribute) {
  GltfMaker m;
  const std::string normalized = R"(,"normalized":true)";
  m.materials = R"({"normalTexture":{"index":0}})";
  m.mesh(R"("POSITION":)" + m.floats("VEC3", square_points) + R"(,"NORMAL":)" +
             m.floats("VEC3", {0, 0, 2, 0, 0, 1, 0, 0, 1, 0, 0, 1}) + R"(,"TEXCOORD_0":)" +
             m.floats("VEC2", {0, 0, 1, 0, 1, 1, 0, 1}) + R"(,"TEXCOORD_1":)" +
             m.values<std::uint8_t>("VEC2", {0, 0, 255, 0, 255, 255, 0, 255}, normalized) + R"(,"COLOR_0":)" +
             m.values<std::uint8_t>("VEC4", {255, 0, 0, 51, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, normalized) +
             R"(,"_CUSTOM":99)",
         R"(,"indices":)" + m.values<std::uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3}) + R"(,"material":0)");
  m.rest = R"(,"textures":[{}])";
  const Scene s = load(m);
  ASSERT_EQ(s.meshes.size(), 1u);
  const Mesh& mesh = s.meshes[0];
  EXPECT_EQ(mesh.index, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh.position[2], (float3{1, 1, 0}));
  EXPECT_EQ(mesh.normal, std::vector<float3>(4, {0, 0, 1}));
  EXPECT_EQ(mesh.uv0[1], (float2{1, 0}));
  EXPECT_EQ(mesh.uv1, mesh.uv0);
  EXPECT_EQ(mesh.color[0], (float4{1, 0, 0, 0.2f}));
  EXPECT_TRUE(mesh.tangent.empty());
  EXPECT_EQ(mesh.material, 0);
}

TEST(GltfMesh, FlatNormalsSplitTheVertices) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}),
         R"(,"indices":)" + m.values<std::uint8_t>("SCALAR", {0, 1, 2, 0, 2, 3}));
  const Mesh mesh = load(m).meshes.at(0);
  ASSERT_EQ(mesh.position.size(), 6u);
  EXPECT_EQ(mesh.normal, (std::vector<float3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}}));
}

TEST(GltfMesh, ModesBecomeLists) {
  for (int mode = 0; mode <= 6; ++mode) {
    GltfMaker m;
    m.mesh(R"("POSITION":)" + m.floats("VEC3", square_points), R"(,"mode":)" + std::to_string(mode));
    const Mesh mesh = load(m).meshes.at(0);
    const std::size_t wanted[] = {4, 2, 4, 3, 1, 2, 2};
    EXPECT_EQ(mesh.primitives(), wanted[mode]) << mode;
    EXPECT_EQ(mesh.normal.empty(), mode < 4);
    EXPECT_EQ(mesh.topology, mode == 0 ? Topology::Points : mode < 4 ? Topology::Lines : Topology::Triangles);
  }
  GltfMaker m = triangle_maker();
  m.meshes.clear();
  m.mesh(R"("POSITION":0)", R"(,"mode":7)");
  EXPECT_EQ(error_of(m), "mesh 0 primitive 0: mode is 7, expected 0 to 6");
}

TEST(GltfMesh, OnlyTheVerticesInTheIndicesRangeAreRead) {
  GltfMaker m;
  std::vector<float> points;
  for (int i = 0; i < 1000; ++i) points.insert(points.end(), {static_cast<float>(i), static_cast<float>(i % 7), 0});
  m.mesh(R"("POSITION":)" + m.floats("VEC3", points) + R"(,"NORMAL":)" + m.floats("VEC3", points),
         R"(,"indices":)" + m.values<std::uint16_t>("SCALAR", {502, 500, 505}));
  const Mesh mesh = load(m).meshes.at(0);
  EXPECT_EQ(mesh.position.size(), 6u);
  EXPECT_EQ(mesh.position[mesh.index[0]], (float3{502, 502 % 7, 0}));
  EXPECT_EQ(mesh.position[mesh.index[1]], (float3{500, 500 % 7, 0}));
}

TEST(GltfMesh, IndicesMustNameVertices) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", square_points),
         R"(,"indices":)" + m.values<std::uint8_t>("SCALAR", {0, 1, 2, 0, 255, 3}));
  EXPECT_EQ(error_of(m), "mesh 0 primitive 0: index 4 is 255, but POSITION has 4 elements");
}

TEST(GltfMesh, AttributesMustBeAsLongAsThePositions) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", square_points) + R"(,"NORMAL":)" + m.floats("VEC3", {0, 0, 1}));
  EXPECT_EQ(error_of(m), "mesh 0 primitive 0: NORMAL has 1 elements, POSITION has 4");
}

TEST(GltfMesh, WithoutPositionNothingIsDrawn) {
  GltfMaker m;
  m.mesh(R"("NORMAL":)" + m.floats("VEC3", square_points));
  const Scene s = load(m);
  EXPECT_TRUE(s.meshes.empty());
  ASSERT_EQ(s.warnings.size(), 2u);
  EXPECT_NE(s.warnings[0].find("mesh 0 primitive 0: has no POSITION"), std::string::npos);
  EXPECT_NE(s.warnings[1].find("nothing in the scene"), std::string::npos);
}

TEST(GltfMesh, VerticesThatAreNotFiniteDropTheirPrimitives) {
  for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    GltfMaker m;
    std::vector<float> points = square_points;
    points[11] = bad;
    m.mesh(R"("POSITION":)" + m.floats("VEC3", points), R"(,"mode":6)");
    const Scene s = load(m);
    ASSERT_EQ(s.meshes.at(0).primitives(), 1u);
    for (const float3 p : s.meshes[0].position) EXPECT_TRUE(is_finite(p));
    ASSERT_EQ(s.warnings.size(), 1u);
    EXPECT_NE(s.warnings[0].find("mesh 0 primitive 0: vertices that are not finite, 1 primitives dropped"),
              std::string::npos);
  }
}

TEST(GltfMesh, ZeroNormalsAreThoseOfTheTriangles) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 0, 1, 0, 0, 0, 1}) + R"(,"NORMAL":)" +
         m.floats("VEC3", {0, 0, 0, 0, 3, 0, 0, 0, 0}));
  EXPECT_EQ(load(m).meshes.at(0).normal, (std::vector<float3>{{1, 0, 0}, {0, 1, 0}, {1, 0, 0}}));
}

TEST(GltfMesh, NormalsAreUnitAtEverySize) {
  for (const float size : {1e-30f, 1.0f, 1e15f, 1e17f})
    for (const float normal : {0.0f, 1e-30f, 1e-20f, 1e30f}) {
      GltfMaker m;
      m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 0, size, 0, 0, 0, size}) + R"(,"NORMAL":)" +
             m.floats("VEC3", {normal, 0, 0, normal, 0, 0, normal, 0, 0}));
      EXPECT_EQ(load(m).meshes.at(0).normal, std::vector<float3>(3, {1, 0, 0})) << size << " " << normal;
    }
}

TEST(GltfMesh, ProvidedTangentsAreKeptOnlyWithNormalsAndANormalTexture) {
  const auto tangents = [](bool has_normal, bool has_texture) {
    GltfMaker m;
    m.materials = has_texture ? R"({"normalTexture":{"index":0}})" : "{}";
    m.rest = R"(,"textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,)"
             "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
             R"("}])";
    m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}) +
               (has_normal ? R"(,"NORMAL":)" + m.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1}) : "") +
               R"(,"TEXCOORD_0":)" + m.floats("VEC2", {0, 1, 1, 1, 0, 0}) + R"(,"TANGENT":)" +
               m.floats("VEC4", {0, 3, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}),
           R"(,"material":0)");
    return load(m).meshes.at(0).tangent;
  };
  EXPECT_TRUE(tangents(true, false).empty());
  EXPECT_EQ(tangents(true, true), std::vector<float4>(3, {0, 1, 0, -1}));
  for (const float4 t : tangents(false, true)) {  // generated from uv, as if the file had none
    EXPECT_NEAR(t.x, 1, 1e-6f);
    EXPECT_EQ(t.w, 1);
  }
}

TEST(GltfMesh, MorphTargetsAtTheirDefaultWeights) {
  const auto positions = [](const std::string& mesh_weights, const std::string& node_weights) {
    GltfMaker m;
    m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    m.floats("VEC3", {0, 0, 2, 0, 0, 2, 0, 0, 2});
    m.floats("VEC3", {0, 4, 0, 0, 4, 0, 0, 4, 0});
    m.meshes = R"({"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1},{"POSITION":2}]}])" +
               mesh_weights + "}";
    m.nodes = R"({"mesh":0)" + node_weights + R"(},{"mesh":0})";
    m.scene_nodes = "0,1";
    return load(m).meshes;
  };
  EXPECT_EQ(positions("", "").at(0).position[1], (float3{1, 0, 0}));
  EXPECT_EQ(positions(R"(,"weights":[0.5,0.25])", "").at(0).position[1], (float3{1, 1, 1}));
  const std::vector<Mesh> two = positions(R"(,"weights":[0.5,0.25])", R"(,"weights":[1,0])");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].position[1], (float3{1, 0, 2}));
  EXPECT_EQ(two[1].position[1], (float3{1, 1, 1}));
}

TEST(GltfMesh, MorphTargetsOfEveryAttribute) {
  GltfMaker m;
  const std::string move = m.floats("VEC3", {0, 0, 2, 0, 0, 2, 0, 0, 2}),
                    turn = m.floats("VEC3", {1, 0, 0, 1, 0, 0, 1, 0, 0});
  const std::string shift = m.floats("VEC2", {4, 2, 4, 2, 4, 2});
  m.meshes = R"({"primitives":[{"attributes":{"POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}) +
             R"(,"NORMAL":)" + m.floats("VEC3", {0, 0, 0.5f, 0, 0, 0.5f, 0, 0, 0.5f}) + R"(,"TEXCOORD_0":)" + shift +
             R"(,"COLOR_0":)" + m.floats("VEC4", {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}) +
             R"(},"targets":[{"POSITION":)" + move + R"(,"NORMAL":)" + turn + R"(,"TEXCOORD_0":)" + shift +
             R"(,"COLOR_0":)" + turn + R"(}]}],"weights":[0.5]})";
  const Mesh mesh = load(m).meshes.at(0);
  EXPECT_EQ(mesh.position[1], (float3{1, 0, 1}));
  EXPECT_NEAR(mesh.normal[0].x, std::sqrt(0.5f), 1e-6f);
  EXPECT_NEAR(mesh.normal[0].z, std::sqrt(0.5f), 1e-6f);
  EXPECT_EQ(mesh.uv0[2], (float2{6, 3}));
  EXPECT_EQ(mesh.color[0], (float4{1, 1, 1, 1}));  // 1.5, clamped
}

TEST(GltfMesh, MorphTargetErrors) {
  GltfMaker m;
  m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  m.floats("VEC3", {0, 0, 2, 0, 0, 2});
  m.meshes = R"({"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1}]}],"weights":[1]})";
  EXPECT_EQ(error_of(m), "mesh 0 primitive 0 target 0: POSITION has 2 elements, expected 3");
  m.meshes = R"({"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1}]}],"weights":[1,1]})";
  EXPECT_EQ(error_of(m), "mesh 0 primitive 0: has 1 morph targets, but 2 weights are given");
}

template <class Joint = std::uint8_t>
GltfMaker skinned(const std::vector<Joint>& joints, const std::vector<float>& weights) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}) + R"(,"JOINTS_0":)" +
         m.values<Joint>("VEC4", joints) + R"(,"WEIGHTS_0":)" + m.floats("VEC4", weights));
  const std::string inverse = m.floats(
      "MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
  m.nodes = R"({"mesh":0,"skin":0,"translation":[100,0,0]},{"translation":[0,0,5]},{"translation":[1,2,0]})";
  m.scene_nodes = "0,1,2";
  m.rest = R"(,"skins":[{"joints":[1,2],"inverseBindMatrices":)" + inverse + "}]";
  return m;
}

TEST(GltfMesh, SkinsTakeThePoseOfTheirJointsAndIgnoreTheNode) {
  const Scene s = load(skinned({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, {1, 0, 0, 0, 2, 0, 0, 0, 0.5f, 0.5f, 0, 0}));
  EXPECT_EQ(s.instances.at(0).world_from_object, float4x4{});
  EXPECT_EQ(s.meshes.at(0).position, (std::vector<float3>{{0, 0, 5}, {1, 2, 0}, {0, 2, 2.5f}}));
}

TEST(GltfMesh, VerticesThatAreNotThereTakeNoMemory) {
  GltfMaker m = triangle_maker();
  m.accessors = R"({"bufferView":0,"componentType":5126,"count":4000000000,"type":"VEC3"})";
  EXPECT_EQ(error_of(m),
            "mesh 0 primitive 0: POSITION (accessor 0): it holds 36 bytes, expected 48000000000 (4000000000 "
            "elements)");
  m.accessors = R"({"componentType":5126,"count":4200000,"type":"VEC3"})";
  EXPECT_EQ(error_of(m),
            "mesh 0 primitive 0: POSITION (accessor 0): has no bufferView for 4200000 elements, at most "
            "4194304 may be zero");
}

TEST(GltfMesh, SkinErrors) {
  EXPECT_EQ(error_of(skinned({0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})),
            "mesh 0 primitive 0: vertex 1 uses joint 2 of 2");
  EXPECT_EQ(error_of(skinned<float>({0, 0, 0, 0, 1e30f, 0, 0, 0, 0, 1, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})),
            "mesh 0 primitive 0: JOINTS_0 (accessor 1): componentType is 5126, expected 5121 or 5123");
  GltfMaker m = skinned({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  m.rest = R"(,"skins":[{"joints":[1,2,0],"inverseBindMatrices":3}])";
  EXPECT_EQ(error_of(m), "skin 0: inverseBindMatrices has 2 elements, expected 3");
  m.rest = R"(,"skins":[{"joints":[]}])";
  EXPECT_EQ(error_of(m), "skin 0: has no joints");
}

}  // namespace
}  // namespace zoneplate
