// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate {
namespace {

Scene wheel_of(const std::string& text) { return make_builtin_scene(text).value(); }

std::string refusal_of(const std::string& text) {
  try {
    make_builtin_scene(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool are_placed_alike(const Scene& a, const Scene& b) {
  for (std::size_t i = 0; i < a.instances.size(); ++i)
    if (a.instances[i].world_from_object != b.instances[i].world_from_object) return false;
  return a.instances.size() == b.instances.size();
}

/// The number of edges that are not used once in each direction; corners with equal positions are the same.
std::size_t open_edge_count(const Mesh& mesh) {
  using Key = std::array<float, 3>;
  const auto key_of = [](float3 p) { return Key{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; };
  std::map<std::pair<Key, Key>, int> uses;
  for (std::size_t i = 0; i < mesh.index.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Key a = key_of(mesh.position[mesh.index[i + k]]), b = key_of(mesh.position[mesh.index[i + (k + 1) % 3]]);
      a < b ? ++uses[{a, b}] : --uses[{b, a}];
    }
  std::size_t open = 0;
  for (const auto& use : uses) open += use.second != 0;
  return open;
}

TEST(Wheel, HasClosedPartsAndSpokesThatEndInHubAndRim) {
  for (const int n : {1, 7, 12, 360}) {
    const Scene scene = wheel_of("wheel:spokes=" + std::to_string(n));
    EXPECT_EQ(scene.objects, (std::vector<std::string>{"spokes", "rim", "hub", "tyre", "cap"}));
    EXPECT_EQ(open_edge_count(scene.meshes[0]), static_cast<std::size_t>(2 * 16 * n));  // both ends of each spoke
    EXPECT_EQ(open_edge_count(scene.meshes[1]), 0u);
    EXPECT_EQ(open_edge_count(scene.meshes[3]), 0u);
    // The spokes' ends are hidden in the hub and in the rim.
    for (const float3 p : scene.meshes[0].position) {
      const float r = std::hypot(p.x, p.y);
      EXPECT_TRUE(r > 0.055f && r < 0.485f && std::abs(p.z) < 0.029f);
    }
  }
}

// After a rotation by one spoke, the mesh is congruent: every vertex coincides with another one.
TEST(Wheel, LooksTheSameOneSpokeFurther) {
  constexpr double pi = 3.141592653589793;
  for (const int n : {5, 12, 31}) {
    for (const Mesh& mesh : wheel_of("wheel:spokes=" + std::to_string(n)).meshes) {
      const double c = std::cos(2 * pi / n), s = std::sin(2 * pi / n);
      for (std::size_t i = 0; i < mesh.position.size(); i += 37) {
        const float3 p = mesh.position[i];
        const double x = c * p.x - s * p.y, y = s * p.x + c * p.y;
        double nearest = 1;
        for (const float3 q : mesh.position) {
          if (q.z == p.z || mesh.material == 0) nearest = std::min(nearest, std::hypot(q.x - x, q.y - y, q.z - p.z));
        }
        ASSERT_LT(nearest, 1e-6) << n << " spokes, vertex " << i;
      }
    }
  }
  EXPECT_TRUE(are_placed_alike(wheel_of("wheel:turn=0.3"), wheel_of("wheel:turn=7.3")));
  EXPECT_FALSE(are_placed_alike(wheel_of("wheel:turn=0.3"), wheel_of("wheel:turn=0.300001")));
}

TEST(Wheel, TurnsClockwiseBySharesOfASpoke) {
  const float4x4 half = wheel_of("wheel:spokes=2,turn=0.5").instances[0].world_from_object;  // a quarter of a turn
  const float3 right = transform_vector(half, {1, 0, 0});
  EXPECT_NEAR(right.x, 0, 3e-7f);
  EXPECT_NEAR(right.y, -1, 3e-7f);
  EXPECT_TRUE(are_placed_alike(wheel_of("wheel:turn=-.25"), wheel_of("wheel:turn=-0.25")));
}

TEST(Wheel, TakesDecimalsOnlyWhereTheyAreMeant) {
  EXPECT_EQ(refusal_of("wheel:spokes=1.5"), "scene wheel: spokes is '1.5', expected a whole number from 1 to 360");
  for (const char* value : {"", ".", "-", "1e3", "0.1234567", "1001", "+1"}) {
    EXPECT_EQ(refusal_of(std::string("wheel:turn=") + value),
              std::string("scene wheel: turn is '") + (value == std::string("0,5") ? "0" : value) +
                  "', expected a number of 6 decimals from -1000 to 1000")
        << value;
  }
  EXPECT_EQ(refusal_of("wheel:turn=1."), "no error");
}

}  // namespace
}  // namespace zoneplate
