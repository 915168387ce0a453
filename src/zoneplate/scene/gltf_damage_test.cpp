// Damaged files: whatever is changed in a model, loading ends with a sound scene or with one line that says why not.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "zoneplate/base/error.h"
#include "zoneplate/image/png.h"
#include "zoneplate/scene/damage_for_test.h"
#include "zoneplate/scene/gltf.h"
#include "zoneplate/scene/gltf_maker_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

std::string load_soundly(const std::string& path) {
  const auto load = [](const std::string& p, const LoadLimits& limits) {
    GltfModel model(p, limits);
    Scene scene = model.scene({});
    if (scene.animations.empty()) return scene;
    expect_sound(scene);
    return model.scene({.animation = SceneChoice::all_animations, .time = 0.4});
  };
  return zoneplate::load_soundly(load, path);
}

/// A small model with a bit of everything.
GltfMaker everything() {
  GltfMaker m;
  const std::string normalized = R"(,"normalized":true)";
  const std::string interleaved =
      m.view<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1}, 24);
  const std::string head = R"({"bufferView":)" + interleaved + R"(,"componentType":5126,"count":4,"type":"VEC3")";
  const std::string position = m.accessor(head + "}"), normal = m.accessor(head + R"(,"byteOffset":12})");
  const std::string uv0 = m.floats("VEC2", {0, 1, 1, 1, 1, 0, 0, 0});
  const std::string uv1 = m.values<std::uint8_t>("VEC2", {0, 255, 255, 255, 255, 0, 0, 0}, normalized);
  const std::string color = m.values<std::uint16_t>("VEC3", std::vector<std::uint16_t>(12, 50000), normalized);
  const std::string indices = m.values<std::uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
  const std::string places = m.view<std::uint8_t>({1, 3}), values = m.view<float>({0, 0, 1, 0, 0, 2});
  const std::string sparse =
      m.accessor(R"({"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":)" +
                 places + R"(,"componentType":5121},"values":{"bufferView":)" + values + "}}}");
  const std::string joints = m.values<std::uint8_t>("VEC4", {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
  const std::string weights = m.floats("VEC4", {0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const std::string image = m.view(encode_png(Rgba8Image(2, 2, {1, 2, 3, 4})));
  const std::string corners = R"("POSITION":)" + position + R"(,"NORMAL":)" + normal;
  m.mesh(corners + R"(,"TEXCOORD_0":)" + uv0 + R"(,"TEXCOORD_1":)" + uv1 + R"(,"COLOR_0":)" + color,
         R"(,"material":0,"mode":4,"indices":)" + indices + R"(,"targets":[{"POSITION":)" + sparse + "}]");
  m.mesh(R"("POSITION":)" + position + R"(,"JOINTS_0":)" + joints + R"(,"WEIGHTS_0":)" + weights, R"(,"mode":5)");
  m.mesh(corners, R"(,"mode":2)");
  m.nodes = R"({"mesh":0,"weights":[0.5],"translation":[1,2,3],"rotation":[0,0,0,1],"scale":[1,-1,1],"children":[1,3]},
      {"mesh":1,"skin":0},{"mesh":2,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},
      {"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}})";
  m.scene_nodes = "0,2";
  m.materials = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":
      {"offset":[0.5,0],"rotation":1,"texCoord":1}}},"metallicFactor":0.5},"normalTexture":{"index":0},
      "alphaMode":"MASK","emissiveFactor":[0,1,0]})";
  const std::string times = m.floats("SCALAR", {0, 1}), turns = m.floats("VEC4", {0, 0, 0, 1, 0, 1, 0, 0});
  const std::string moves = m.floats("VEC3", std::vector<float>(18, 1)), shares = m.floats("SCALAR", {0, 1});
  const auto channel = [](int sampler, const char* path) {
    return R"({"sampler":)" + std::to_string(sampler) + R"(,"target":{"node":0,"path":")" + path + "\"}}";
  };
  const auto sampler = [&](const std::string& output, const char* kind) {
    return R"({"input":)" + times + R"(,"output":)" + output + R"(,"interpolation":")" + kind + "\"}";
  };
  const std::string animation = R"(,"animations":[{"channels":[)" + channel(0, "rotation") + "," +
                                channel(1, "translation") + "," + channel(2, "weights") + R"(],"samplers":[)" +
                                sampler(turns, "LINEAR") + "," + sampler(moves, "CUBICSPLINE") + "," +
                                sampler(shares, "STEP") + "]}]";
  m.rest = animation + R"(,"textures":[{"source":0,"sampler":0}],"samplers":[{"minFilter":9987,"wrapS":33071}],
      "images":[{"bufferView":)" +
           image + R"(}],"skins":[{"joints":[0,3]}],
      "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1,"zfar":10}}],
      "extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":5,"spot":{"outerConeAngle":0.5}}]}})";
  return m;
}

TEST(GltfDamage, TheModelItselfIsSound) {
  const MemoryFile file;
  EXPECT_EQ(load_soundly(file.write(everything().glb())), "");
}

TEST(GltfDamage, AnyByteChanged) {
  const std::vector<std::uint8_t> good = everything().glb();
  const MemoryFile file;
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    std::vector<std::uint8_t> bytes = good;
    for (auto n = 1 + random() % 3; n > 0; --n) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    refused += load_soundly(file.write(bytes)) != "";
    if (HasFatalFailure()) FAIL() << "case " << i;
  }
  EXPECT_GT(refused, 400);
  EXPECT_LT(refused, 3900);
}

TEST(GltfDamage, AnyNumberReplaced) {
  const GltfMaker m = everything();
  const std::string json = m.json();
  std::vector<std::pair<std::size_t, std::size_t>> numbers;  // where each begins and ends
  for (std::size_t i = 1; i < json.size(); ++i) {
    const std::size_t end = std::min(json.find_first_not_of("0123456789.", i), json.size());
    if (end == i || std::string(":,[").find(json[i - 1]) == std::string::npos) continue;
    numbers.push_back({i, end});
    i = end;
  }
  ASSERT_GT(numbers.size(), 100u);
  const MemoryFile file;
  std::size_t refused = 0;
  for (const auto& [begin, end] : numbers)
    for (const char* value : {"-1", "0", "1", "3", "255", "5125", "0.5", "65536", "4294967295", "9007199254740991",
                              "1e300", "null", "\"x\"", "[]", "{}", "[0,0]", "true", "3e38"}) {
      const std::string damaged = json.substr(0, begin) + value + json.substr(end);
      refused += load_soundly(file.write(GltfMaker::glb(damaged, m.binary))) != "";
      if (HasFatalFailure()) FAIL() << damaged;
    }
  EXPECT_GT(refused, numbers.size() * 6);
}

TEST(GltfDamage, AnyLength) {
  const std::vector<std::uint8_t> good = everything().glb();
  const MemoryFile file;
  for (std::size_t n = 0; n < good.size(); n += 3)
    EXPECT_NE(load_soundly(file.write({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n)})), "") << n;
}

/// The models of a folder beside the sources, if it is there.
std::vector<std::string> shared_models(const std::string& folder) {
  std::vector<std::string> out;
  const fs::path root = fs::path(ZONEPLATE_SOURCE_DIR) / "../shared/data" / folder;
  if (!fs::exists(root)) return out;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") out.push_back(entry.path().string());
  return out;
}

TEST(GltfDamage, SharedModelsLoad) {
  const std::vector<std::string> models = shared_models("models/gltf");
  if (models.empty()) GTEST_SKIP() << "no shared models";
  for (const std::string& path : models) {
    const Scene s = load_gltf(path);
    expect_sound(s);
    EXPECT_FALSE(s.instances.empty()) << path;
  }
}

TEST(GltfDamage, SharedInvalidModelsAreRefusedOrSound) {
  const std::vector<std::string> models = shared_models("invalid/gltf");
  if (models.empty()) GTEST_SKIP() << "no shared models";
  for (const std::string& path : models) {
    const std::string error = load_soundly(path);
    EXPECT_TRUE(error.empty() || error.starts_with(path)) << error;
  }
}

}  // namespace
}  // namespace zoneplate
