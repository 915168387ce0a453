// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/gltf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/load_for_test.h"

namespace zoneplate {
namespace {

void expect_close(float3 a, float3 b) {
  EXPECT_NEAR(a.x, b.x, 1e-6f);
  EXPECT_NEAR(a.y, b.y, 1e-6f);
  EXPECT_NEAR(a.z, b.z, 1e-6f);
}

TEST(Gltf, TheSmallestScene) {
  const Scene s = load(triangle_maker());
  ASSERT_EQ(s.meshes.size(), 1u);
  ASSERT_EQ(s.instances.size(), 1u);
  EXPECT_EQ(s.instances[0].world_from_object, float4x4{});
  EXPECT_EQ(s.objects, std::vector<std::string>{"node 0"});
  ASSERT_EQ(s.materials.size(), 1u);
  EXPECT_EQ(s.materials[0].name, "default");
  EXPECT_EQ(s.meshes[0].material, 0);
  EXPECT_EQ(s.meshes[0].normal, std::vector<float3>(3, {0, 0, 1}));
  EXPECT_TRUE(s.warnings.empty());
}

TEST(Gltf, NodesComposeFromTheRootDown) {
  GltfMaker m = triangle_maker();
  m.nodes = R"({"translation":[10,0,0],"rotation":[0,0,0.70710678,0.70710678],"children":[1]},
               {"scale":[2,-3,1],"children":[2]},
               {"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 1,1,1,1],"mesh":0,"name":"leaf"})";
  const Scene s = load(m);
  ASSERT_EQ(s.instances.size(), 1u);
  EXPECT_EQ(s.objects, std::vector<std::string>{"leaf"});
  // (1,0,0) is translated to (2,1,1), scaled to (4,-3,1), rotated by 90 degrees to (3,4,1), and translated to (13,4,1).
  expect_close(transform_point(s.instances[0].world_from_object, {1, 0, 0}), {13, 4, 1});
  EXPECT_LT(determinant3(s.instances[0].world_from_object), 0);
}

TEST(Gltf, NodesShareTheirMesh) {
  GltfMaker m = triangle_maker();
  m.nodes = R"({"mesh":0},{"mesh":0,"translation":[1,2,3]})";
  m.scene_nodes = "1,0";
  const Scene s = load(m);
  EXPECT_EQ(s.meshes.size(), 1u);
  ASSERT_EQ(s.instances.size(), 2u);
  EXPECT_EQ(s.objects, (std::vector<std::string>{"node 1", "node 0"}));
  EXPECT_EQ(s.instances[0].object, 0);
  EXPECT_EQ(s.instances[0].world_from_object.column[3], (float4{1, 2, 3, 1}));
  EXPECT_EQ(s.bounds().high, (float3{2, 3, 3}));
}

TEST(Gltf, OnlyTheDefaultScene) {
  GltfMaker m = triangle_maker();
  m.nodes = R"({"mesh":0,"name":"a"},{"mesh":0,"name":"b"},{"children":[1]})";
  const auto objects = [&](const std::string& scenes) {
    GltfMaker copy = m;
    std::string json = copy.json();
    const std::string old = R"("scene":0,"scenes":[{"nodes":[0]}],)";
    json.replace(json.find(old), old.size(), scenes);
    const TestFolder folder;
    return load_gltf(folder.write("f.glb", GltfMaker::glb(json, copy.binary))).objects;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(objects(R"("scene":1,"scenes":[{"nodes":[0]},{"nodes":[1]}],)"), Names{"b"});
  EXPECT_EQ(objects(R"("scenes":[{"nodes":[0]},{"nodes":[1]}],)"), Names{"a"});
  EXPECT_EQ(objects(""), (Names{"a", "b"}));  // all nodes without a parent
  EXPECT_THROW(objects(R"("scene":2,"scenes":[{},{}],)"), Error);
  EXPECT_THROW(objects(R"("scene":0,)"), Error);
  EXPECT_TRUE(objects(R"("scenes":[{}],)").empty());
}

TEST(Gltf, NodeTreesAreChecked) {
  GltfMaker m = triangle_maker();
  m.nodes = R"({"children":[1]},{"children":[0]})";
  EXPECT_EQ(error_of(m), "node 0: is reached twice, a node may have one parent only");
  m.nodes = R"({"children":[0]})";
  EXPECT_EQ(error_of(m), "node 0: is reached twice, a node may have one parent only");
  m.nodes = R"({"children":[1,2]},{"children":[2]},{})";
  EXPECT_EQ(error_of(m), "node 2: is reached twice, a node may have one parent only");
  m.nodes = R"({"children":[3]})";
  EXPECT_EQ(error_of(m), "node 0: children holds 3, expected indices below 1");
  m.nodes = R"({"children":[1]},{"children":[2]},{"mesh":0})";
  EXPECT_EQ(error_of(m, {.node_depth = 2}), "node 2: lies deeper than the limit of 2 nodes");
  EXPECT_EQ(error_of(m, {.node_depth = 3}), "no error");
  m.nodes = R"({"mesh":1})";
  EXPECT_EQ(error_of(m), "node 0: mesh is 1, expected an index below 1");
  m.nodes = R"({"mesh":0,"matrix":[1,2]})";
  EXPECT_EQ(error_of(m), "node 0: matrix holds 2 numbers, expected 16");
  m.nodes = R"({"mesh":0,"scale":[1,2,"x"]})";
  EXPECT_EQ(error_of(m), "node 0: scale holds a string, expected numbers");
}

TEST(Gltf, WhatLiesNowhereIsDropped) {
  for (const char* node : {R"({"mesh":0,"translation":[3e38,0,0]})", R"({"scale":[3e38,1,1],"children":[1]},
                           {"scale":[3e38,1,1],"mesh":0})"}) {
    GltfMaker m = triangle_maker();
    m.nodes = node;
    const Scene s = load(m);
    EXPECT_TRUE(s.instances.empty());
    EXPECT_EQ(s.warnings.size(), 2u);
  }
}

TEST(Gltf, Cameras) {
  GltfMaker m = triangle_maker();
  m.nodes = R"({"camera":0,"translation":[1,2,3],"scale":[2,2,2]},{"camera":1},{"camera":2})";
  m.scene_nodes = "0,1,2";
  m.rest = R"(,"cameras":[{"name":"c","type":"perspective","perspective":{"yfov":0.5,"znear":0.1,"aspectRatio":1.5}},
              {"type":"perspective","perspective":{"yfov":1,"znear":1,"zfar":10}},
              {"type":"orthographic","orthographic":{"xmag":3,"ymag":2,"znear":0,"zfar":5}}])";
  const Scene s = load(m);
  ASSERT_EQ(s.cameras.size(), 3u);
  EXPECT_EQ(s.cameras[0].name, "c");
  EXPECT_EQ(s.cameras[0].vertical_fov, 0.5f);
  EXPECT_EQ(s.cameras[0].near, 0.1f);
  EXPECT_EQ(s.cameras[0].aspect, 1.5f);
  EXPECT_TRUE(std::isinf(s.cameras[0].far));
  EXPECT_EQ(s.cameras[0].world_from_camera, translation({1, 2, 3}));  // the scale is ignored
  EXPECT_EQ(s.cameras[1].far, 10);
  EXPECT_EQ(s.cameras[1].aspect, 0);
  EXPECT_TRUE(s.cameras[2].is_orthographic);
  EXPECT_EQ(s.cameras[2].half_height, 2);
  EXPECT_EQ(s.cameras[2].aspect, 1.5f);
  EXPECT_EQ(s.cameras[2].near, 0);
}

TEST(Gltf, CamerasLookAlongMinusZOfTheirNode) {
  GltfMaker m = triangle_maker();
  m.nodes = R"({"camera":0,"rotation":[0,0.70710678,0,0.70710678],"scale":[-3,2,5]})";
  m.rest = R"(,"cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}])";
  const float4x4 world = load(m).cameras.at(0).world_from_camera;
  expect_close(transform_vector(world, {0, 0, -1}), {-1, 0, 0});
  expect_close(transform_vector(world, {0, 1, 0}), {0, 1, 0});
  EXPECT_NEAR(determinant3(world), 1, 1e-6f);
}

TEST(Gltf, CameraErrors) {
  const auto error = [](const std::string& camera) {
    GltfMaker m = triangle_maker();
    m.nodes = R"({"camera":0})";
    m.rest = R"(,"cameras":[{"type":)" + camera + "}]";
    return error_of(m);
  };
  EXPECT_NE(error(R"("fisheye")").find("camera 0: type is 'fisheye'"), std::string::npos);
  EXPECT_EQ(error(R"("perspective")"), "camera 0 perspective: znear is missing");
  for (const char* lens : {R"("yfov":0,"znear":1)", R"("yfov":3.2,"znear":1)", R"("yfov":1,"znear":0)",
                           R"("yfov":1,"znear":1,"zfar":1)", R"("yfov":1,"znear":1,"aspectRatio":-1)"})
    EXPECT_NE(error(R"("perspective","perspective":{)" + std::string(lens) + "}"), "no error") << lens;
  for (const char* lens : {R"("xmag":0,"ymag":1,"znear":0,"zfar":1)", R"("xmag":1,"ymag":1,"znear":-1,"zfar":1)",
                           R"("xmag":1,"ymag":1,"znear":1)"})
    EXPECT_NE(error(R"("orthographic","orthographic":{)" + std::string(lens) + "}"), "no error") << lens;
}

TEST(Gltf, Lights) {
  GltfMaker m = triangle_maker();
  const auto node = [](int light, const std::string& more) {
    return R"({"extensions":{"KHR_lights_punctual":{"light":)" + std::to_string(light) + "}}" + more + "}";
  };
  m.nodes = node(0, R"(,"rotation":[0.70710678,0,0,0.70710678],"scale":[2,2,2])") + "," +
            node(1, R"(,"translation":[1,2,3])") + "," + node(2, "");
  m.scene_nodes = "0,1,2";
  m.rest = R"(,"extensionsRequired":["KHR_lights_punctual"],"extensionsUsed":["KHR_lights_punctual"],
      "extensions":{"KHR_lights_punctual":{"lights":[{"type":"directional","color":[1,0.5,0],"intensity":3},
      {"type":"point","range":7,"name":"p"},{"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}}]}})";
  const Scene s = load(m);
  ASSERT_EQ(s.lights.size(), 3u);
  EXPECT_TRUE(s.needs_fill_light);
  EXPECT_EQ(s.lights[0].kind, LightKind::Directional);
  EXPECT_EQ(s.lights[0].color, (float3{1, 0.5f, 0}));
  EXPECT_EQ(s.lights[0].intensity, 3);
  expect_close(s.lights[0].direction, {0, 1, 0});  // -Z rotated by 90 degrees about X
  EXPECT_TRUE(std::isinf(s.lights[0].range));
  EXPECT_EQ(s.lights[1].kind, LightKind::Point);
  EXPECT_EQ(s.lights[1].position, (float3{1, 2, 3}));
  EXPECT_EQ(s.lights[1].range, 7);
  EXPECT_EQ(s.lights[1].name, "p");
  EXPECT_EQ(s.lights[2].kind, LightKind::Spot);
  EXPECT_EQ(s.lights[2].inner_cone, 0.1f);
  EXPECT_EQ(s.lights[2].outer_cone, 0.2f);
  m.nodes = node(3, "");
  m.scene_nodes = "0";
  EXPECT_EQ(error_of(m), "node 0 KHR_lights_punctual: light is 3, expected an index below 3");
}

TEST(Gltf, ExtensionsAreNamed) {
  GltfMaker m = triangle_maker();
  m.rest = R"(,"extensionsRequired":["KHR_x"],"extensionsUsed":["KHR_x"])";
  EXPECT_EQ(error_of(m), "requires the extension 'KHR_x', which is not supported");
  m.rest = R"(,"extensionsUsed":["KHR_x","KHR_materials_unlit","KHR_x","KHR_y"])";
  const Scene s = load(m);
  ASSERT_EQ(s.warnings.size(), 2u);
  EXPECT_NE(s.warnings[0].find("extension 'KHR_x' is not supported, ignored"), std::string::npos);
  EXPECT_NE(s.warnings[1].find("extension 'KHR_y' is not supported, ignored"), std::string::npos);
}

TEST(Gltf, Instancing) {
  GltfMaker m = triangle_maker();
  const std::string moves = m.floats("VEC3", {1, 0, 0, 0, 1, 0}), scales = m.floats("VEC3", {2, 2, 2, 1, 1, 1});
  m.nodes =
      R"({"mesh":0,"translation":[10,0,0],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
      moves + R"(,"SCALE":)" + scales + "}}}}";
  const Scene s = load(m);
  ASSERT_EQ(s.instances.size(), 2u);
  EXPECT_EQ(s.meshes.size(), 1u);
  EXPECT_EQ(s.objects.size(), 2u);
  EXPECT_EQ(s.instances[0].world_from_object, translation({11, 0, 0}) * scaling({2, 2, 2}));
  EXPECT_EQ(s.instances[1].world_from_object, translation({10, 1, 0}));
}

TEST(Gltf, MissingFilesAreNamed) {
  try {
    load_gltf("/nowhere/x.glb");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    EXPECT_NE(std::string(e.what()).find("/nowhere/x.glb"), std::string::npos);
  }
}

/// Copying the name of 10,000 letters to each of 50,000 instances would take 500 MB for a file of a few thousand bytes.
TEST(Gltf, PlacementsShareTheNameOfTheirNode) {
  GltfMaker m = triangle_maker();
  const std::string name(10000, 'n');
  const std::string places = m.accessor(R"({"componentType":5126,"count":50000,"type":"VEC3"})");
  m.nodes = R"({"mesh":0,"name":")" + name +
            R"(","extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" + places + "}}}}";
  const Scene s = load(m, {.memory = 8 << 20});
  ASSERT_EQ(s.objects.size(), 50000u);
  EXPECT_EQ(s.instances.size(), 50000u);
  EXPECT_EQ(s.instances.back().object, 49999);
  EXPECT_EQ(s.objects[49999], name);
  EXPECT_EQ(s.objects.texts().size(), 1u);
  EXPECT_NE(error_of(m, {.memory = 3 << 20}).find("--max-memory"), std::string::npos);
}

TEST(Gltf, NodesShareTheNameOfTheirMesh) {
  GltfMaker m = triangle_maker();
  const std::string name(100000, 'x');
  m.meshes = R"({"name":")" + name + R"(",)" + m.meshes.substr(1);
  m.nodes = R"({"mesh":0},{"mesh":0,"name":"own"})";
  m.scene_nodes = "0,1";
  for (int i = 2; i < 600; ++i) m.nodes += R"(,{"mesh":0})", m.scene_nodes += "," + std::to_string(i);
  const Scene s = load(m, {.memory = 4 << 20});
  ASSERT_EQ(s.objects.size(), 600u);
  EXPECT_EQ(s.objects[1], "own");
  EXPECT_EQ(s.objects[599], name);
  EXPECT_EQ(s.objects.texts().size(), 2u);
}

TEST(Gltf, ElementsWithoutBytesAreFewInAll) {
  GltfMaker m;
  std::string primitives;
  for (int i = 0; i < 1000; ++i) {
    const std::string zeros = m.accessor(R"({"componentType":5126,"count":4000000,"type":"VEC3"})");
    primitives += (i == 0 ? "" : ",") + (R"({"mode":0,"attributes":{"POSITION":)" + zeros + "}}");
  }
  m.meshes = R"({"primitives":[)" + primitives + "]}";
  const std::string text = error_of(m);
  EXPECT_NE(text.find("may be zero"), std::string::npos) << text;
}

/// In a file without scenes, roots are searched among all nodes; quadratic time would take 10^10 comparisons here.
TEST(Gltf, TimeIsLinearInNodesAndKeys) {
  GltfMaker m = triangle_maker();
  m.nodes = R"({"mesh":0})";
  for (int i = 1; i < 100000; ++i) m.nodes += ",{}";
  std::string json = m.json();
  const std::string scenes = R"("scene":0,"scenes":[{"nodes":[0]}],)";
  std::string keys;
  for (int i = 0; i < 100000; ++i) keys += "\"k" + std::to_string(i) + "\":0,";
  json.replace(json.find(R"("scene":0)"), scenes.size() - 1, keys.substr(0, keys.size() - 1));
  const TestFolder folder;
  const std::clock_t begin = std::clock();
  const Scene s = load_gltf(folder.write("f.glb", GltfMaker::glb(json, m.binary)));
  EXPECT_EQ(s.instances.size(), 1u);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 20);
}

/// Nodes with the same mesh and skin share one mesh of the scene.
TEST(Gltf, NodesOfOneSkinShareTheirMesh) {
  GltfMaker m;
  const std::string positions = m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::string joints = m.values<std::uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const std::string weights = m.floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  m.mesh(R"("POSITION":)" + positions + R"(,"JOINTS_0":)" + joints + R"(,"WEIGHTS_0":)" + weights);
  m.nodes = R"({"mesh":0,"skin":0},{"mesh":0,"skin":0},{"translation":[5,0,0]},{"mesh":0})";
  m.scene_nodes = "0,1,2,3";
  m.rest = R"(,"skins":[{"joints":[2]}])";
  const Scene s = load(m);
  ASSERT_EQ(s.instances.size(), 3u);
  EXPECT_EQ(s.meshes.size(), 2u);
  EXPECT_EQ(s.instances[0].mesh, s.instances[1].mesh);
  EXPECT_EQ(s.meshes[static_cast<std::size_t>(s.instances[1].mesh)].position[1], (float3{6, 0, 0}));
  EXPECT_EQ(s.meshes[static_cast<std::size_t>(s.instances[2].mesh)].position[1], (float3{1, 0, 0}));
}

/// The triangle with the bounds that the specification requires, at a place that floats round to 0.5.
GltfMaker far_maker() {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.values<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, R"(,"min":[0,0,0],"max":[1,1,0])"));
  m.nodes = R"({"mesh":0,"translation":[500000.1,5200000.2,300.3]})";
  return m;
}

double3 place_of(const Scene& s, float3 p, std::size_t instance = 0) {
  const Instance& i = s.instances.at(instance);
  const Mesh& mesh = s.meshes[static_cast<std::size_t>(i.mesh)];
  const auto vertex = static_cast<std::size_t>(p == float3{} ? 0 : p.x > 0 ? 1 : 2);
  return s.in_file(transform_point(i.world_from_object, mesh.position[vertex]));
}

void expect_place(double3 found, double3 wanted) {
  EXPECT_NEAR(found.x, wanted.x, 1e-6);
  EXPECT_NEAR(found.y, wanted.y, 1e-6);
  EXPECT_NEAR(found.z, wanted.z, 1e-6);
}

TEST(Gltf, NodesFarFromTheOriginKeepTheirPlaces) {
  const Scene s = load(far_maker());
  EXPECT_LE(length(narrowed(s.origin - double3{500000.6, 5200000.7, 300.3})), 0.5f);
  expect_place(place_of(s, {1, 0, 0}), {500001.1, 5200000.2, 300.3});
  EXPECT_LT(s.bounds().high.y, 2);
}

TEST(Gltf, AFarAxisTurnIsAppliedToDoubles) {
  // x, y up and z of the scene are x, z and -y of the survey.
  GltfMaker m = far_maker();
  m.nodes = R"({"rotation":[-0.7071067811865475,0,0,0.7071067811865476],"children":[1,2]},
               {"mesh":0,"translation":[500000.1,5200000.2,300.3]},
               {"mesh":0,"matrix":[0,1,0,0, -1,0,0,0, 0,0,1,0, 500002.3,5200000.4,300.5,1]})";
  const Scene s = load(m);
  expect_place(place_of(s, {0, 1, 0}), {500000.1, 300.3, -5200001.2});
  expect_place(place_of(s, {1, 0, 0}, 1), {500002.3, 300.5, -5200001.4});
}

TEST(Gltf, FarMeshesInstancesCamerasAndLightsShareOneWorld) {
  GltfMaker m = far_maker();
  m.mesh(R"("POSITION":)" + m.values<float>("VEC3", {500001, 5200000, 300, 500002, 5200000, 300, 500001, 5200001, 300},
                                            R"(,"min":[500001,5200000,300],"max":[500002,5200001,300])"));
  const std::string copies = m.floats("VEC3", {0, 0, 0, 2, 3, 4});
  m.nodes += R"(,{"mesh":1},{"mesh":0,"translation":[500000.1,5200000.2,300.3],
                 "extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
             copies + R"(}}}},{"camera":0,"translation":[500000.3,5200000.1,309.7],
                 "extensions":{"KHR_lights_punctual":{"light":0}}})";
  m.scene_nodes = "0,1,2,3";
  m.rest = R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],
              "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})";
  const Scene s = load(m);
  ASSERT_EQ(s.instances.size(), 4u);
  expect_place(place_of(s, {1, 0, 0}, 1), {500002, 5200000, 300});
  expect_place(place_of(s, {1, 0, 0}, 2), {500001.1, 5200000.2, 300.3});
  expect_place(place_of(s, {1, 0, 0}, 3), {500003.1, 5200003.2, 304.3});
  expect_place(s.in_file(xyz(s.cameras.at(0).world_from_camera.column[3])), {500000.3, 5200000.1, 309.7});
  expect_place(s.in_file(s.lights.at(0).position), {500000.3, 5200000.1, 309.7});
}

// Nodes that draw nothing do not decide whether a scene is far, unless all are hidden.
TEST(Gltf, HiddenNodesDoNotChooseTheOrigin) {
  GltfMaker m = far_maker();
  const double3 origin = load(m).origin;
  const std::string hidden = R"("extensions":{"KHR_node_visibility":{"visible":false}})";
  m.scene_nodes = "0,1";
  for (const std::string& node : {R"({"mesh":0,)" + hidden + "}", std::string(R"({"mesh":0,"scale":[0,0,0]})")}) {
    m.nodes = R"({"mesh":0,"translation":[500000.1,5200000.2,300.3]},)" + node;
    EXPECT_EQ(load(m).origin, origin) << node;
  }
  m.nodes = R"({"mesh":0,"translation":[500000.1,5200000.2,300.3],)" + hidden + R"(},{"scale":[0,0,0]})";
  EXPECT_EQ(load(m).origin, origin);
}

TEST(Gltf, NodesNearTheOriginKeepTheirBits) {
  GltfMaker m = far_maker();
  m.nodes = R"({"translation":[12.3,-40.7,0.1],"rotation":[0.1,0.2,0.3,0.9],"children":[1]},
               {"mesh":0,"translation":[3.3,0.7,0.1]})";
  const Scene s = load(m);
  EXPECT_EQ(s.origin, double3{});
  EXPECT_EQ(s.instances[0].world_from_object, translation({12.3f, -40.7f, 0.1f}) *
                                                  rotation(Quaternion{0.1f, 0.2f, 0.3f, 0.9f}) *
                                                  translation({3.3f, 0.7f, 0.1f}));
}

TEST(Gltf, SkinsFarFromTheOriginKeepTheirPlaces) {
  GltfMaker m = far_maker();
  const std::string joints = m.values<std::uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
  const std::string weights = m.floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  m.meshes =
      R"({"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":)" + joints + R"(,"WEIGHTS_0":)" + weights + "}}]}";
  m.nodes = R"({"mesh":0,"skin":0},{"translation":[500000.1,5200000.2,300.3],"children":[2]},
               {"translation":[0.4,0.5,0.6]})";
  m.scene_nodes = "0,1";
  m.rest = R"(,"skins":[{"joints":[1,2]}])";
  const Scene s = load(m);
  EXPECT_NE(s.origin, double3{});
  expect_place(place_of(s, {1, 0, 0}), {500001.1, 5200000.2, 300.3});
  expect_place(place_of(s, {0, 1, 0}), {500000.5, 5200001.7, 300.9});
}

}  // namespace
}  // namespace zoneplate
