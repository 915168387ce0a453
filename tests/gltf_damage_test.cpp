// SPDX-License-Identifier: Apache-2.0
// Damaged files: loading any modification of a model gives a valid scene or an error message of one line.
#include <gtest/gtest.h>

#include <random>

#include "zoneplate/base/error.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/sample_for_test.h"
#include "zoneplate/formats/import/damage_for_test.h"

namespace zoneplate {
namespace {

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
  std::vector<std::pair<std::size_t, std::size_t>> numbers;  // the first and last character of each
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
  EXPECT_GT(refused, numbers.size() * 2);
}

TEST(GltfDamage, AnyLength) {
  const std::vector<std::uint8_t> good = everything().glb();
  const MemoryFile file;
  for (std::size_t n = 0; n < good.size(); n += 3)
    EXPECT_NE(load_soundly(file.write({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n)})), "") << n;
}

class SharedGltf : public testing::TestWithParam<std::string> {};
TEST_P(SharedGltf, Loads) {
  const Scene s = load_gltf(GetParam());
  expect_sound(s);
  EXPECT_FALSE(s.instances.empty());
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedGltf);
INSTANTIATE_TEST_SUITE_P(GltfDamage, SharedGltf,
                         testing::ValuesIn(shared_files_ending("data/models/gltf", {".gltf", ".glb"})));

class SharedInvalidGltf : public testing::TestWithParam<std::string> {};
TEST_P(SharedInvalidGltf, IsRefusedOrSound) {
  const std::string error = load_soundly(GetParam());
  EXPECT_TRUE(error.empty() || error.starts_with(GetParam())) << error;
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedInvalidGltf);
INSTANTIATE_TEST_SUITE_P(GltfDamage, SharedInvalidGltf,
                         testing::ValuesIn(shared_files_ending("data/invalid/gltf", {".gltf", ".glb"})));

}  // namespace
}  // namespace zoneplate
