// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/animation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/base/error.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

/// Keys at 1 s and 3 s on node 0.
GltfMaker animated(const std::string& path, const std::string& interpolation, const std::string& type,
                   const std::vector<float>& values, const std::vector<float>& times = {1, 3}) {
  GltfMaker m = triangle_maker();
  const std::string input = m.floats("SCALAR", times), output = m.floats(type, values);
  m.rest = R"(,"animations":[{"name":"move","channels":[{"sampler":0,"target":{"node":0,"path":")" + path +
           R"("}}],"samplers":[{"input":)" + input + R"(,"output":)" + output + R"(,"interpolation":")" +
           interpolation + "\"}]}]";
  return m;
}

Scene at(const GltfMaker& m, double time, const LoadLimits& limits = {}) {
  const TestFolder folder;
  return load_gltf(folder.write("a.glb", m.glb()), limits, {.animation = 0, .time = time});
}

float3 moved(const GltfMaker& m, double time, float3 p = {0, 0, 0}) {
  return transform_point(at(m, time).instances.at(0).world_from_object, p);
}

void expect_near(float3 found, float3 wanted, float tolerance = 2e-6f) {
  EXPECT_NEAR(found.x, wanted.x, tolerance);
  EXPECT_NEAR(found.y, wanted.y, tolerance);
  EXPECT_NEAR(found.z, wanted.z, tolerance);
}

TEST(GltfAnimation, LinearAndStepAndWhatIsBeforeAndAfter) {
  const GltfMaker linear = animated("translation", "LINEAR", "VEC3", {0, 0, 0, 4, 8, -2});
  const GltfMaker step = animated("translation", "STEP", "VEC3", {0, 0, 0, 4, 8, -2});
  expect_near(moved(linear, 0), {0, 0, 0});
  expect_near(moved(linear, 1.5), {1, 2, -0.5f});
  expect_near(moved(linear, 2.5), {3, 6, -1.5f});
  expect_near(moved(linear, 9), {4, 8, -2});
  expect_near(moved(step, 2.999), {0, 0, 0});
  expect_near(moved(step, 3), {4, 8, -2});
}

TEST(GltfAnimation, RotationsGoTheShorterWayAtConstantSpeed) {
  // From 0 to 120 degrees about z, where the second quaternion is negated: a third of the way is 40 degrees.
  const float s = std::sin(1.0471975512f), c = std::cos(1.0471975512f);
  const GltfMaker m = animated("rotation", "LINEAR", "VEC4", {0, 0, 0, 1, 0, 0, -s, -c}, {0, 3});
  expect_near(moved(m, 1, {1, 0, 0}), {std::cos(0.6981317f), std::sin(0.6981317f), 0});
  expect_near(moved(m, 3, {1, 0, 0}), {-0.5f, std::sin(2.0943951f), 0});
}

TEST(GltfAnimation, CubicSplinesUseTangentsTimesTheSpan) {
  // Each key has in-tangent, value and out-tangent; at the middle the basis functions are h = 1/2, 1/8, 1/2, -1/8.
  const GltfMaker m = animated("scale", "CUBICSPLINE", "VEC3", {9, 9, 9, 1, 1, 1, 1, 2, 0, 4, 0, 0, 3, 1, 1, 9, 9, 9});
  expect_near(moved(m, 2, {1, 1, 1}), {0.5f + 2.0f / 8 + 1.5f - 8.0f / 8, 0.5f + 4.0f / 8 + 0.5f, 0.5f + 0.5f});
  expect_near(moved(m, 1, {1, 1, 1}), {1, 1, 1});
  expect_near(moved(m, 3, {1, 1, 1}), {3, 1, 1});
}

TEST(GltfAnimation, WeightsMoveMorphTargets) {
  GltfMaker m;
  const std::string target = m.floats("VEC3", {0, 0, 4, 0, 0, 4, 0, 0, 4});
  const std::string other = m.floats("VEC3", {2, 0, 0, 2, 0, 0, 2, 0, 0});
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}),
         R"(,"targets":[{"POSITION":)" + target + R"(},{"POSITION":)" + other + "}]");
  const std::string input = m.floats("SCALAR", {0, 2}), output = m.floats("SCALAR", {0, 1, 1, 0});
  m.rest = R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}],"samplers":[{"input":)" +
           input + R"(,"output":)" + output + "}]}]";
  expect_near(at(m, 0.5).meshes.at(0).position.at(0), {1.5f, 0, 1});
}

TEST(GltfAnimation, ListsNamesAndSpansAndPlaysAllOrOne) {
  const GltfMaker m = animated("translation", "LINEAR", "VEC3", {0, 0, 0, 4, 8, -2});
  const Scene s = at(m, 0);
  ASSERT_EQ(s.animations.size(), 1u);
  EXPECT_EQ(s.animations[0].name, "move");
  EXPECT_EQ(s.animations[0].begin, 1);
  EXPECT_EQ(s.animations[0].end, 3);
  const TestFolder folder;
  const std::string path = folder.write("a.glb", m.glb());
  const Scene all = load_gltf(path, {}, {.animation = SceneChoice::all_animations, .time = 2});
  expect_near(transform_point(all.instances.at(0).world_from_object, {}), {2, 4, -1});
  const Scene named = load_gltf(path, {}, {.time = 2, .animation_name = "move"});
  expect_near(transform_point(named.instances.at(0).world_from_object, {}), {2, 4, -1});
  try {
    load_gltf(path, {}, {.animation_name = "Run"});
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "--animation-index: the file has no animation 'Run'; it has 'move'");
  }
  try {
    load_gltf(path, {}, {.animation = 1});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Usage);
    EXPECT_STREQ(e.what(), "--animation-index: the file has animations 0 to 0, not 1");
  }
}

std::string refusal(const GltfMaker& m) {
  try {
    at(m, 1.5, {.is_strict = true});
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    const std::string text = e.what();
    return text.substr(text.find("animation 0"));
  }
  return "loaded";
}

TEST(GltfAnimation, Refusals) {
  EXPECT_EQ(refusal(animated("translation", "LINEAR", "VEC3", {0, 0, 0, 1, 1, 1}, {3, 1})),
            "animation 0 sampler 0: input 1 is 1.000000, expected growing times");
  EXPECT_EQ(refusal(animated("translation", "CUBICSPLINE", "VEC3", {0, 0, 0, 1, 1, 1})),
            "animation 0 sampler 0: output has 2 elements, expected 6");
  EXPECT_EQ(refusal(animated("translation", "SMOOTH", "VEC3", {0, 0, 0, 1, 1, 1})),
            "animation 0 sampler 0: interpolation is 'SMOOTH', expected STEP, LINEAR or CUBICSPLINE");
  EXPECT_EQ(refusal(animated("translation", "LINEAR", "VEC3", {0, 0, 0, INFINITY, 1, 1})),
            "animation 0 sampler 0: output is not finite");
}

// Joint 1 rotates by 90 degrees in a second about a point 2 above the ground; vertices follow it according to their
// weights.
TEST(GltfAnimation, JointsMoveVerticesByTheirWeights) {
  GltfMaker m;
  const std::string position = m.floats("VEC3", {1, 0, 0, 1, 2, 0, 1, 4, 0});
  const std::string joints = m.values<std::uint8_t>("VEC4", {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  const std::string weights = m.floats("VEC4", {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0, 1, 0, 0});
  // The inverse of each joint's position at rest: the origin, and (0, 2, 0).
  const std::string binds = m.floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,  //
                                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1});
  m.mesh(R"("POSITION":)" + position + R"(,"JOINTS_0":)" + joints + R"(,"WEIGHTS_0":)" + weights);
  m.nodes = R"({"mesh":0,"skin":0},{"children":[2]},{"translation":[0,2,0]})";
  m.scene_nodes = "0,1";
  const float r = std::sqrt(0.5f);
  const std::string input = m.floats("SCALAR", {0, 1}), output = m.floats("VEC4", {0, 0, 0, 1, 0, 0, r, r});
  m.rest =
      R"(,"skins":[{"joints":[1,2],"inverseBindMatrices":)" + binds +
      R"(}],"animations":[{"channels":[{"sampler":0,"target":{"node":2,"path":"rotation"}}],"samplers":[{"input":)" +
      input + R"(,"output":)" + output + "}]}]";
  const Scene rest = at(m, 0), half = at(m, 0.5), end = at(m, 1);
  for (std::size_t i = 0; i < 3; ++i) expect_near(rest.meshes.at(0).position.at(i), {1, 2 * static_cast<float>(i), 0});
  expect_near(half.meshes.at(0).position.at(0), {1, 0, 0});
  expect_near(half.meshes.at(0).position.at(1), {(1 + r) / 2, 2 + r / 2, 0});
  expect_near(half.meshes.at(0).position.at(2), {r - 2 * r, 2 + r + 2 * r, 0});
  expect_near(end.meshes.at(0).position.at(1), {0.5f, 2.5f, 0});
  expect_near(end.meshes.at(0).position.at(2), {-2, 3, 0});
}

/// Models of the Khronos Group, if they are present in the shared data.
class SharedAnimation : public testing::TestWithParam<std::string> {};
class SharedInterpolationTest : public SharedAnimation {};
class SharedRiggedSimple : public SharedAnimation {};
class SharedMorphCube : public SharedAnimation {};
class SharedSuzanne : public SharedAnimation {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedInterpolationTest);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedRiggedSimple);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedMorphCube);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedSuzanne);
const std::string models = "data/models/gltf";
INSTANTIATE_TEST_SUITE_P(GltfAnimation, SharedInterpolationTest,
                         testing::ValuesIn(shared_files(models, {"InterpolationTest.glb"})));
INSTANTIATE_TEST_SUITE_P(GltfAnimation, SharedRiggedSimple,
                         testing::ValuesIn(shared_files(models, {"RiggedSimple.glb"})));
INSTANTIATE_TEST_SUITE_P(GltfAnimation, SharedMorphCube,
                         testing::ValuesIn(shared_files(models, {"AnimatedMorphCube.glb"})));
INSTANTIATE_TEST_SUITE_P(GltfCompression, SharedSuzanne,
                         testing::ValuesIn(shared_files(models + "/compressed",
                                                        {"Suzanne-draco.glb", "Suzanne-meshopt-quantized.glb",
                                                         "Suzanne-quantized.glb"})));

// The point (1, 1/2, 0) of each cube, computed independently of this program with the formulas of the specification.
TEST_P(SharedInterpolationTest, PointsAreWhereTheSpecificationPutsThem) {
  const struct {
    double time;
    float3 points[9];
  } rows[] = {{0,
               {{1, 0.5f, 0},
                {-2.29633f, 0.5f, 6.5e-05f},
                {4.340119f, 0.5f, 0.008945f},
                {1, 3.856412f, 0},
                {4.335062f, 3.856412f, 0},
                {-2.311399f, 3.856412f, 0},
                {1, 7.165226f, 0},
                {4.30518f, 7.140117f, 0},
                {-2.297581f, 7.121015f, 0}}},
              {5.0 / 24,
               {{1, 0.5f, 0},
                {-2.518552f, 0.388889f, 6.5e-05f},
                {4.131615f, 0.395748f, 0.008945f},
                {1, 3.856412f, 0},
                {4.449872f, 3.44126f, 0},
                {-2.196178f, 3.435669f, 0},
                {1, 7.165226f, 0},
                {4.30518f, 8.820059f, 0},
                {-2.297581f, 8.810507f, 0}}},
              {15.0 / 24,
               {{0.5f, 0.25f, 0},
                {-2.569057f, 0.363636f, 6.5e-05f},
                {4.056122f, 0.358002f, 0.008945f},
                {1.06066f, 3.002859f, 0},
                {4.224277f, 2.678698f, 0},
                {-2.441168f, 2.654488f, 0},
                {1, 10.5f, 0},
                {4.30518f, 8.5f, 0},
                {-2.297581f, 8.5f, 0}}},
              {25.0 / 24,
               {{1, 0.5f, 0},
                {-2.518552f, 0.388889f, 6.5e-05f},
                {4.131615f, 0.395748f, 0.008945f},
                {0.5f, 2.356412f, 0},
                {3.506801f, 2.251647f, 0},
                {-3.183573f, 2.24571f, 0},
                {1, 6.5f, 0},
                {4.30518f, 8.5f, 0},
                {-2.297581f, 8.5f, 0}}},
              {2,
               {{1, 0.5f, 0},
                {-2.29633f, 0.5f, 6.5e-05f},
                {4.340119f, 0.5f, 0.008945f},
                {-1, 2.856412f, 0},
                {2.335062f, 2.856412f, 0},
                {-4.311399f, 2.856413f, 0},
                {1, 6.5f, 0},
                {4.30518f, 6.5f, 0},
                {-2.297581f, 6.5f, 0}}}};
  GltfModel model(GetParam());
  for (const auto& row : rows) {
    const Scene s = model.scene({.animation = SceneChoice::all_animations, .time = row.time});
    ASSERT_EQ(s.instances.size(), 10u);
    for (std::size_t i = 0; i < 9; ++i)
      expect_near(transform_point(s.instances[i].world_from_object, {1, 0.5f, 0}), row.points[i], 5e-6f);
  }
}

TEST_P(SharedRiggedSimple, Bends) {
  const struct {
    double time;
    float3 foot, top;  // vertices 0 and 159
  } rows[] = {{0, {0, -4.57508f, 1}, {-0.17224f, 4.57508f, 0.41582f}},
              {0.5, {0, -4.57508f, 1}, {1.0742f, 4.45817f, 0.41582f}},
              {1, {0, -4.57508f, 1}, {2.34424f, 3.94942f, 0.41582f}},
              {1.53, {0, -4.57508f, 1}, {1.26907f, 4.40782f, 0.41582f}},
              {3, {0, -4.57508f, 1}, {-0.17224f, 4.57508f, 0.41582f}}};
  GltfModel model(GetParam());
  for (const auto& row : rows) {
    const Scene s = model.scene({.animation = 0, .time = row.time});
    expect_near(s.meshes.at(0).position.at(0), row.foot, 1e-5f);
    expect_near(s.meshes.at(0).position.at(159), row.top, 1e-5f);
  }
}

TEST_P(SharedMorphCube, Bends) {
  constexpr std::pair<double, float> rows[] = {{0, 1}, {0.5, 0.56089f}, {1.25, -0.66076f}, {2.6, 0.28645f}, {9, 1}};
  GltfModel model(GetParam());
  for (const auto& [time, z] : rows) {
    const Scene s = model.scene({.animation = 0, .time = time});
    const float4x4& world = s.instances.at(0).world_from_object;
    expect_near(transform_point(world, s.meshes.at(0).position.at(2)), {-1, -1, z}, 1e-5f);
    expect_near(transform_point(world, s.meshes.at(0).position.at(3)), {1, -1, z}, 1e-5f);
  }
}

// The compressed model: its vertices are close to those of the uncompressed file.
TEST_P(SharedSuzanne, IsNearThePlainModel) {
  const std::vector<std::string> plain = shared_files(models, {"Suzanne/Suzanne.gltf"});
  ASSERT_EQ(plain.size(), 1u);
  const Box wanted = load_gltf(plain[0]).bounds();
  const Scene s = load_gltf(GetParam());
  ASSERT_EQ(s.meshes.size(), 1u);
  EXPECT_EQ(s.meshes[0].primitives(), 3936u);
  expect_near(s.bounds().low, wanted.low, 2e-3f);
  expect_near(s.bounds().high, wanted.high, 2e-3f);
}

/// Node 0 with mesh 0, a camera and a light, a material, and one animation of a property, with keys at 1 s and 3 s.
GltfMaker pointing(const std::string& pointer, const std::string& type, const std::vector<float>& values,
                   const std::string& interpolation = "LINEAR") {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}), R"(,"material":0)");
  const std::string input = m.floats("SCALAR", {1, 3}), output = m.floats(type, values);
  m.nodes = R"({"mesh":0,"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}})";
  m.materials = R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]},"emissiveFactor":[0.5,0.5,0.5],
      "extensions":{"KHR_materials_clearcoat":{},"KHR_materials_ior":{"ior":0}}})";
  m.rest = R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],
      "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":2}]}},
      "animations":[{"channels":[{"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":
      {"pointer":")" +
           pointer + R"("}}}}],"samplers":[{"input":)" + input + R"(,"output":)" + output + R"(,"interpolation":")" +
           interpolation + "\"}]}]";
  return m;
}

TEST(GltfAnimation, PointersAnimateProperties) {
  const GltfMaker move = pointing("/nodes/0/translation", "VEC3", {0, 0, 0, 4, 8, -2});
  expect_near(moved(move, 1.5), {1, 2, -0.5f});
  const float s = std::sin(1.0471975512f), c = std::cos(1.0471975512f);
  const GltfMaker turn = pointing("/nodes/0/rotation", "VEC4", {0, 0, 0, 1, 0, 0, -s, -c});
  expect_near(moved(turn, 1 + 2.0 / 3, {1, 0, 0}), {std::cos(0.6981317f), std::sin(0.6981317f), 0});

  const GltfMaker base =
      pointing("/materials/0/pbrMetallicRoughness/baseColorFactor", "VEC4", {0, 0, 0, 1, 1, 0, 0.5f, 0});
  EXPECT_EQ(at(base, 2).materials.at(0).base_color, (float4{0.5f, 0, 0.25f, 0.5f}));
  // A property that the file leaves at its default.
  const GltfMaker rough = pointing("/materials/0/pbrMetallicRoughness/roughnessFactor", "SCALAR", {0, 1});
  EXPECT_EQ(at(rough, 1.5).materials.at(0).roughness, 0.25f);
  const GltfMaker coat = pointing("/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", "SCALAR", {0, 1});
  EXPECT_EQ(at(coat, 2).materials.at(0).layers->clearcoat, 0.5f);
  EXPECT_EQ(at(pointing("/cameras/0/perspective/yfov", "SCALAR", {1, 2}), 2).cameras.at(0).vertical_fov, 1.5f);
  EXPECT_EQ(
      at(pointing("/extensions/KHR_lights_punctual/lights/0/intensity", "SCALAR", {2, 4}), 2).lights.at(0).intensity,
      3);
}

TEST(GltfAnimation, PointersToOtherThingsAreIgnored) {
  for (const char* pointer : {"/nodes/0/mesh", "/nodes/9/translation", "/materials/0", "translation", "",
                              "/materials/0/normalTexture/scale", "/asset/version", "/nodes/0/translation/0"}) {
    const Scene s = at(pointing(pointer, "SCALAR", {0, 1}), 2);
    EXPECT_EQ(s.instances.size(), 1u) << pointer;
    EXPECT_EQ(s.warnings.size(), 1u) << pointer;
  }
  const Scene s = at(pointing("/materials/0/extensions/KHR_materials_ior/ior", "SCALAR", {1, 2}), 2);
  EXPECT_EQ(s.materials.at(0).layers->ior, 0);  // a mode that animations leave as it is
}

TEST(GltfAnimation, APointersValueEndsWithItsFrame) {
  const TestFolder folder;
  GltfModel model(folder.write("a.glb", pointing("/materials/0/emissiveFactor", "VEC3", {0, 0, 0, 1, 1, 1}).glb()));
  EXPECT_EQ(model.scene({.animation = 0, .time = 2.5}).materials.at(0).emissive, (float3{0.75f, 0.75f, 0.75f}));
  EXPECT_EQ(model.scene({.animation = 0, .time = 1}).materials.at(0).emissive, float3{});
  EXPECT_EQ(model.scene({}).materials.at(0).emissive, (float3{0.5f, 0.5f, 0.5f}));
}

TEST(GltfNodes, InvisibleNodesHideTheirChildren) {
  GltfMaker m = triangle_maker();
  m.nodes = R"({"children":[1,2],"extensions":{"KHR_node_visibility":{"visible":false}}},
      {"mesh":0,"extensions":{"KHR_node_visibility":{"visible":true}}},
      {"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}},{"mesh":0}, {"mesh":0,"extensions":{"KHR_node_visibility":{}}})";
  m.scene_nodes = "0,3,4";
  m.rest = R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],
      "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})";
  const TestFolder folder;
  const Scene s = load_gltf(folder.write("a.glb", m.glb()));
  EXPECT_EQ(s.instances.size(), 2u);
  EXPECT_TRUE(s.lights.empty());
  EXPECT_EQ(s.cameras.size(), 1u);  // cameras are not subject to visibility
}

TEST(GltfNodes, VisibilityIsAnimated) {
  GltfMaker m = pointing("/nodes/0/extensions/KHR_node_visibility/visible", "SCALAR", {1, 0}, "STEP");
  m.nodes = R"({"mesh":0,"extensions":{"KHR_node_visibility":{}}},{"mesh":0,"name":"after"})";
  m.scene_nodes = "0,1";
  const Scene shown = at(m, 2), hidden = at(m, 3);
  ASSERT_EQ(shown.instances.size(), 2u);
  ASSERT_EQ(hidden.instances.size(), 1u);
  EXPECT_EQ(hidden.meshes.size(), 1u);
  // The other object keeps its number.
  EXPECT_EQ(shown.instances[1].object, 1);
  EXPECT_EQ(hidden.instances[0].object, 1);
  EXPECT_EQ(hidden.objects.size(), 2u);
  EXPECT_EQ(hidden.objects[1], "after");
}

// A primitive that is dropped, here for vertices that are not finite, leaves the others' numbers.
TEST(GltfNodes, InstancesOfANodeHaveTheNumbersOfTheirPrimitives) {
  GltfMaker m;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string good = m.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}),
                    bad = m.floats("VEC3", {nan, 0, 0, 1, 0, 0, 0, 1, 0});
  m.meshes = R"({"primitives":[{"attributes":{"POSITION":)" + good + R"(}},{"attributes":{"POSITION":)" + bad +
             R"(}},{"attributes":{"POSITION":)" + good + "}}]}";
  const TestFolder folder;
  const Scene s = load_gltf(folder.write("a.glb", m.glb()));
  ASSERT_EQ(s.instances.size(), 2u);
  EXPECT_EQ(s.instances[0].part, 0);
  EXPECT_EQ(s.instances[1].part, 2);
}

/// A node far away whose children move near it, and one that an animation carries far away itself.
TEST(GltfAnimation, AFarSceneHasOneOriginAtAllTimes) {
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.values<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, R"(,"min":[0,0,0],"max":[1,1,0])"));
  const std::string input = m.floats("SCALAR", {1, 3}), near = m.floats("VEC3", {0, 0, 0, 400, 8, -2});
  const std::string far = m.floats("VEC3", {500000, 5200000, 300, 500500, 5200000, 300});
  const auto move = [&](const std::string& output) {
    m.rest =
        R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],"samplers":[{"input":)" +
        input + R"(,"output":)" + output + "}]}]";
  };
  m.nodes = R"({"mesh":0},{"translation":[500000.1,5200000.2,300.3],"children":[0]})";
  m.scene_nodes = "1";
  move(near);
  const auto place = [](const Scene& s) { return s.in_file(xyz(s.instances.at(0).world_from_object.column[3])); };
  const Scene first = at(m, 0), last = at(m, 3);
  EXPECT_NE(first.origin, double3{});
  EXPECT_EQ(last.origin, first.origin);
  EXPECT_NEAR(place(first).x, 500000.1, 1e-6);
  EXPECT_NEAR(place(last).x, 500400.1, 1e-4);
  EXPECT_NEAR(place(last).y, 5200008.2, 1e-4);

  m.nodes = R"({"mesh":0})", m.scene_nodes = "0";
  move(far);
  EXPECT_NE(at(m, 0).origin, double3{});
  EXPECT_EQ(at(m, 2).origin, at(m, 0).origin);
  EXPECT_NEAR(place(at(m, 2)).x, 500250, 1e-4);
  EXPECT_EQ(place(at(m, 2)).y, 5200000);
}

}  // namespace
}  // namespace zoneplate
