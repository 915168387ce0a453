// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/key_times.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/maker_for_test.h"

namespace zoneplate {
namespace {

/// A triangle, and one animation of node 0 whose channels are added one by one.
struct Animated {
  GltfMaker maker = triangle_maker();
  std::string channels, samplers;
  int count = 0;

  void add(const std::string& target, const std::string& type, const std::vector<float>& times,
           const std::vector<float>& values, const std::string& interpolation = "LINEAR") {
    const std::string comma = count == 0 ? "" : ",";
    channels += comma + R"({"sampler":)" + std::to_string(count++) + R"(,"target":)" + target + "}";
    samplers += comma + R"({"input":)" + maker.floats("SCALAR", times) + R"(,"output":)" + maker.floats(type, values) +
                R"(,"interpolation":")" + interpolation + "\"}";
  }
  std::vector<double> times(const SceneChoice& choice = {.animation = 0}) {
    maker.rest = R"(,"animations":[{"name":"a","channels":[)" + channels + R"(],"samplers":[)" + samplers + "]}]";
    const TestFolder folder;
    return GltfModel(folder.write("a.glb", maker.glb())).key_times(choice);
  }
};

std::string of(const char* path) { return std::string(R"({"node":0,"path":")") + path + "\"}"; }

std::vector<double> sorted(std::vector<double> times) {
  std::ranges::sort(times);
  return times;
}

using Times = std::vector<double>;

TEST(GltfKeyTimes, AreThoseOfTheChosenAnimation) {
  Animated a;
  a.add(of("translation"), "VEC3", {0, 1, 2.5f, 4}, {0, 0, 0, 1, 0, 0, 1, 9, 0, 0, 0, 0});
  EXPECT_EQ(sorted(a.times()), (Times{0, 1, 2.5, 4}));
  EXPECT_EQ(a.times({}), Times{});
  EXPECT_EQ(sorted(a.times({.animation = SceneChoice::all_animations})), (Times{0, 1, 2.5, 4}));
  EXPECT_EQ(sorted(a.times({.animation_name = "a"})), (Times{0, 1, 2.5, 4}));
  EXPECT_THROW(a.times({.animation = 1}), Error);
}

TEST(GltfKeyTimes, ExtremesOfTheWidestRangeComeFirst) {
  Animated a;
  std::vector<float> times, values;
  for (int i = 0; i < 3000; ++i) {
    times.push_back(static_cast<float>(i) / 32);
    const float x = static_cast<float>(i % 7) / 8;
    values.insert(values.end(), {x, i == 1234 ? 9.0f : 0.0f, i == 777 ? -5.0f : 0.0f});
  }
  a.add(of("translation"), "VEC3", times, values);
  const Times found = a.times();
  EXPECT_LE(found.size(), 1024u);
  const auto place = [&](double time) { return std::ranges::find(found, time) - found.begin(); };
  EXPECT_LE(place(1234.0 / 32), 1);
  EXPECT_LE(place(777.0 / 32), 3);
  // Those that are left out are no long stretch of the animation.
  const Times all = sorted(found);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_LE(all[i] - all[i - 1], 0.5);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
}

TEST(GltfKeyTimes, HaveTimesBetweenTheKeysOfWhatIsCurved) {
  Animated turn;
  turn.add(of("rotation"), "VEC4", {0, 4}, {0, 0, 0, 1, 0, 0, 1, 0});
  EXPECT_EQ(sorted(turn.times()), (Times{0, 1, 2, 3, 4}));
  Animated step;
  step.add(of("rotation"), "VEC4", {0, 4}, {0, 0, 0, 1, 0, 0, 1, 0}, "STEP");
  EXPECT_EQ(sorted(step.times()), (Times{0, 4}));
  Animated cubic;
  cubic.add(of("scale"), "VEC3", {0, 2}, {0, 0, 0, 1, 1, 1, 9, 9, 9, 0, 0, 0, 1, 1, 1, 0, 0, 0}, "CUBICSPLINE");
  EXPECT_EQ(sorted(cubic.times()), (Times{0, 0.5, 1, 1.5, 2}));
}

TEST(GltfKeyTimes, PointersCountIfTheyChangeTheShape) {
  const auto pointer = [](const char* to) {
    return std::string(R"({"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":")") + to + "\"}}}";
  };
  Animated a;
  a.add(pointer("/nodes/0/translation"), "VEC3", {0, 1}, {0, 0, 0, 1, 0, 0});
  a.add(pointer("/nodes/0/extensions/KHR_node_visibility/visible"), "SCALAR", {0, 3}, {0, 1}, "STEP");
  a.add(pointer("/materials/0/emissiveFactor"), "VEC3", {0, 2}, {0, 0, 0, 1, 0, 0});
  EXPECT_EQ(sorted(a.times()), (Times{0, 1, 3}));
}

}  // namespace
}  // namespace zoneplate
