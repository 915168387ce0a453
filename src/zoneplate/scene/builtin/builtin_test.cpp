// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/builtin/builtin.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

Scene made(const std::string& text) {
  std::optional<Scene> scene = make_builtin_scene(text);
  EXPECT_TRUE(scene.has_value()) << text;
  return std::move(*scene);
}

std::string message_of(const std::string& text) {
  try {
    make_builtin_scene(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    return error.what();
  }
  return "no error";
}

std::size_t triangles_of(const Scene& scene) {
  std::size_t n = 0;
  for (const Mesh& mesh : scene.meshes) n += mesh.primitives();
  return n;
}

using Key = std::array<float, 3>;
Key key_of(float3 p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }  // -0 is 0

/// The number of uses of each directed edge minus those in the opposite direction; corners with equal positions are the
/// same.
std::map<std::pair<Key, Key>, int> open_edges(const Mesh& mesh) {
  std::map<std::pair<Key, Key>, int> uses;
  for (std::size_t i = 0; i < mesh.index.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Key a = key_of(mesh.position[mesh.index[i + k]]), b = key_of(mesh.position[mesh.index[i + (k + 1) % 3]]);
      a < b ? ++uses[{a, b}] : --uses[{b, a}];
    }
  for (auto i = uses.begin(); i != uses.end();) i = i->second == 0 ? uses.erase(i) : std::next(i);
  return uses;
}

void expect_sound(const Scene& scene) {
  ASSERT_FALSE(scene.materials.empty());
  for (const Instance& i : scene.instances) {
    EXPECT_LT(static_cast<std::size_t>(i.mesh), scene.meshes.size());
    EXPECT_LT(static_cast<std::size_t>(i.object), scene.objects.size());
  }
  for (const Mesh& mesh : scene.meshes) {
    EXPECT_LT(static_cast<std::size_t>(mesh.material), scene.materials.size());
    ASSERT_EQ(mesh.normal.size(), mesh.position.size());
    for (std::size_t v = 0; v < mesh.position.size(); ++v) {
      ASSERT_TRUE(is_finite(mesh.position[v]));
      ASSERT_NEAR(length(mesh.normal[v]), 1, 1e-5f);
    }
    for (std::size_t i = 0; i < mesh.index.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k) ASSERT_LT(mesh.index[i + k], mesh.position.size());
      // The front face is on the side of the normals.
      const auto p = [&](std::size_t k) { return mesh.position[mesh.index[i + k]]; };
      const auto n = [&](std::size_t k) { return mesh.normal[mesh.index[i + k]]; };
      ASSERT_GT(dot(cross(p(1) - p(0), p(2) - p(0)), n(0) + n(1) + n(2)), 0) << "triangle " << i / 3;
    }
  }
}

TEST(BuiltinScenes, AreAllSound) {
  for (const BuiltinScene& listed : builtin_scenes()) {
    if (listed.name == "micro" || listed.name == "tri1m") continue;
    SCOPED_TRACE(listed.name);
    expect_sound(made(listed.name));
    EXPECT_FALSE(listed.summary.empty());
  }
}

TEST(BuiltinScenes, RefuseWhatTheyDoNotKnow) {
  EXPECT_FALSE(make_builtin_scene("chair.gltf").has_value());
  EXPECT_FALSE(make_builtin_scene("teapots").has_value());
  EXPECT_FALSE(make_builtin_scene("").has_value());
  EXPECT_EQ(message_of("teapot:division=3"), "scene teapot: unknown parameter 'division'; did you mean 'divisions'?");
  EXPECT_EQ(message_of("teapot:divisions=0"), "scene teapot: divisions is '0', expected a whole number from 1 to 512");
  EXPECT_EQ(message_of("sphere:triangles=1e6"),
            "scene sphere: triangles is '1e6', expected a whole number from 12 to 100000000");
  EXPECT_EQ(message_of("sphere:triangles"), "scene sphere: triangles requires a value: 12 to 100000000");
  EXPECT_EQ(message_of("city:"), "scene city: unknown parameter ''; it has none");
}

TEST(Teapot, HasItsTrianglesAndClosedPatches) {
  for (const int n : {1, 2, 5, 16}) {
    const Scene scene = made("teapot:divisions=" + std::to_string(n));
    // 32 patches of 2 n² triangles, minus n at each of the eight patches that end in a point of the axis.
    EXPECT_EQ(triangles_of(scene), static_cast<std::size_t>(64 * n * n - 8 * n));
    EXPECT_EQ(scene.objects, (std::vector<std::string>{"body", "lid", "handle", "spout"}));
    // The open edges are the mouth of the body, the rim of the lid, and both ends of handle and spout.
    // (With one division the tubes are flat: the two edges of an end coincide.)
    const auto ring = static_cast<std::size_t>(4 * n);
    const std::size_t ends = n == 1 ? 0 : ring;
    EXPECT_EQ(open_edges(scene.meshes[0]).size(), ring);
    EXPECT_EQ(open_edges(scene.meshes[1]).size(), ring);
    EXPECT_EQ(open_edges(scene.meshes[2]).size(), ends);
    EXPECT_EQ(open_edges(scene.meshes[3]).size(), ends);
  }
}

TEST(Teapot, StandsUprightOnTheGround) {
  Box box;
  for (const Mesh& mesh : made("teapot").meshes)
    for (const float3 p : mesh.position) box.add(p);
  EXPECT_EQ(box.low.y, 0);
  EXPECT_EQ(box.high.y, 3.15f / 16);
  EXPECT_EQ(box.low.z, -box.high.z);
  EXPECT_GT(box.high.x, -box.low.x);  // the spout extends farther than the handle
}

TEST(Sphere, IsClosedAndHasTheTrianglesAskedFor) {
  for (const auto& [requested, given] : {std::pair{12, 12u}, {13, 48u}, {48, 48u}, {49, 108u}, {10000, 10092u}}) {
    const Scene scene = made("sphere:triangles=" + std::to_string(requested));
    EXPECT_EQ(triangles_of(scene), given);
    EXPECT_TRUE(open_edges(scene.meshes[0]).empty());
  }
}

TEST(Sphere, IsTheSameForAnyNumberOfThreads) {
  Scene one, many;
  with_threads(1, [&] { one = made("sphere:triangles=5000"); });
  with_threads(7, [&] { many = made("sphere:triangles=5000"); });
  EXPECT_EQ(one.meshes[0].position, many.meshes[0].position);
  EXPECT_EQ(one.meshes[0].normal, many.meshes[0].normal);
  EXPECT_EQ(one.meshes[0].index, many.meshes[0].index);
}

TEST(City, HasItsBoxesAndItsGround) {
  const Scene scene = made("city");
  EXPECT_EQ(triangles_of(scene), 48002u);
  EXPECT_EQ(scene.meshes[0].position.size(), 4u * (4000 * 6 + 1));
  EXPECT_EQ(scene.images.at(0).pixels.width(), 1024);
  EXPECT_EQ(scene.cameras.size(), 1u);
}

TEST(Triangles, ShowTheirColoursAndStandWhereTheyShould) {
  const Scene scene = made("triangles");
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].position, (std::vector<float3>{{2, 0, -2}, {0, 2, -2}, {-2, 0, -2}}));
  EXPECT_EQ(scene.meshes[1].position, (std::vector<float3>{{3.5f, -1, -5}, {2.5f, 1.5f, -5}, {-1, 0.5f, -5}}));
  EXPECT_EQ(scene.materials[0].base_color, (float4{decode_srgb8(217), decode_srgb8(238), decode_srgb8(185), 1}));
  EXPECT_EQ(scene.materials[1].base_color, (float4{decode_srgb8(185), decode_srgb8(217), decode_srgb8(238), 1}));
  const Camera& camera = scene.cameras.at(0);
  EXPECT_EQ(xyz(camera.world_from_camera.column[3]), (float3{0, 0, 5}));
  EXPECT_EQ(camera.near, 0.1f);
  EXPECT_EQ(camera.far, 50);
}

TEST(Cyclic, EachTriangleIsBeforeTheNext) {
  const Scene scene = made("cyclic");
  ASSERT_EQ(scene.meshes.size(), 3u);
  // As seen along -Z from the eye: where a triangle's long axis crosses its neighbour's, the triangle is nearer.
  const auto axis = [&](std::size_t i) {
    const auto& p = scene.meshes[i].position;
    return std::pair{p[0], (p[1] + p[2]) * 0.5f};
  };
  const float3 eye{0, 0, 5};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [a, b] = axis(i);
    const auto [c, d] = axis((i + 1) % 3);
    // a + s (b - a) and c + t (d - c) are on one ray from the eye: solve for s, t and the ratio of their distances.
    const float3 n = cross(c - eye, d - eye);  // plane through the eye and the neighbour's axis
    const float s = dot(eye - a, n) / dot(b - a, n);
    const float3 p = a + s * (b - a);
    const float3 m = cross(a - eye, b - eye);
    const float t = dot(eye - c, m) / dot(d - c, m);
    const float3 q = c + t * (d - c);
    ASSERT_TRUE(s > 0 && s < 1 && t > 0 && t < 1);
    EXPECT_LT(length(p - eye) + 0.3f, length(q - eye));
  }
}

TEST(Checkerboard, ReachesTheHorizon) {
  const Scene scene = made("checkerboard");
  EXPECT_EQ(open_edges(scene.meshes[0]).size(), 4u * 13);  // only its outer border is open
  const Rgba8Image& image = scene.images.at(0).pixels.as<Rgba8>();
  EXPECT_NE(image(0, 0), image(64, 0));
  EXPECT_EQ(image(0, 0), image(64, 64));
  EXPECT_EQ(image(0, 0), image(63, 63));
}

}  // namespace
}  // namespace zoneplate
