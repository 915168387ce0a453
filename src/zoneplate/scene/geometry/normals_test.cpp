// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/scene/geometry/smooth_normals.h"

namespace zoneplate {
namespace {

/// A strip around the y axis of `sides` faces, each bent by 360 / sides degrees, without normals.
Mesh prism(std::uint32_t sides) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 6.283185307179586 * i / sides;
    const auto x = static_cast<float>(std::cos(angle)), z = static_cast<float>(-std::sin(angle));
    mesh.position.push_back({x, -1, z}), mesh.position.push_back({x, 1, z});
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
    mesh.index.insert(mesh.index.end(), {a, b, a + 1, a + 1, b, b + 1});
  }
  return mesh;
}

TEST(Normals, AreSmoothBelowTheCreaseAndFlatAbove) {
  constexpr float degrees = 3.14159265f / 180;
  for (const auto& [crease, is_smooth] : {std::pair{30.0f, false}, {44.0f, false}, {46.0f, true}, {70.0f, true}}) {
    Mesh mesh = prism(8);  // bends by 45 degrees
    make_normals(mesh, crease * degrees);
    EXPECT_EQ(mesh.position.size(), is_smooth ? 16u : 32u) << crease;
    for (std::size_t v = 0; v < mesh.position.size(); ++v) {
      const float along = mesh.normal[v].x * mesh.position[v].x + mesh.normal[v].z * mesh.position[v].z;
      EXPECT_NEAR(along, is_smooth ? 1 : std::cos(22.5f * degrees), 0.02f) << crease;
    }
  }
}

TEST(Normals, AreFlatWithoutACrease) {
  Mesh mesh = prism(64);
  mesh.tangent.assign(mesh.position.size(), {1, 0, 0, 1});
  make_normals(mesh, 0);
  EXPECT_TRUE(mesh.tangent.empty());
  for (std::size_t i = 0; i < mesh.index.size(); i += 3) {
    const float3 normal = mesh.normal[mesh.index[i]];
    EXPECT_EQ(mesh.normal[mesh.index[i + 1]], normal);
    EXPECT_EQ(mesh.normal[mesh.index[i + 2]], normal);
  }
}

TEST(Normals, AreThoseOfFilesByDefault) {
  Mesh mesh = prism(7), file = prism(7);
  make_normals(mesh);
  make_smooth_normals(file);
  EXPECT_EQ(mesh.normal, file.normal);
  EXPECT_EQ(mesh.index, file.index);
}

}  // namespace
}  // namespace zoneplate
