// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/user_shader.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

/// A triangle over the whole image whose colour is the place on the screen.
struct PlaceShader {
  struct Varyings {
    float x, y;
  };
  std::pair<float4, Varyings> vertex(const Vertex& v) const {
    const float x = v.index == 1 ? 3.0f : -1.0f, y = v.index == 2 ? 3.0f : -1.0f;
    // w differs by vertex, so that only perspective-correct weights give the place back.
    const float w = 1.0f + static_cast<float>(v.index);
    return {{x * w, y * w, 0.5f * w, w}, {x, y}};
  }
  float4 fragment(const Varyings& u, const Varyings& ux, const Varyings& uy) const { return {u.x, u.y, ux.x, uy.y}; }
};

struct Nested {
  float3 normal;
  struct {
    float2 uv;
    float weight[2];
  } rest;
};
struct WithInt {
  float x;
  int id;
};
struct WithBytes {
  float x;
  std::uint8_t color[4];
};
static_assert(holds_only_floats<PlaceShader::Varyings>() && holds_only_floats<Nested>());
static_assert(!holds_only_floats<WithInt>() && !holds_only_floats<WithBytes>() && !holds_only_floats<double>());

TEST(UserShader, GivesUsersShadersPerspectiveCorrectVaryingsAndSlopes) {
  const std::uint32_t indices[] = {0, 1, 2};
  const int size = 64;
  const LinearImage image = draw(PlaceShader{}, indices, 3, size, size);
  // 1 / w is affine on the screen; x and y are what was projected, so they are not affine: check 1/w's own weights.
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double sx = (x + 0.5) / size * 2 - 1, sy = 1 - (y + 0.5) / size * 2;
      const double l1 = (sx + 1) / 4, l2 = (sy + 1) / 4, l0 = 1 - l1 - l2;  // screen-space weights
      const double q0 = l0, q1 = l1 / 2, q2 = l2 / 3, q = q0 + q1 + q2;
      EXPECT_NEAR(image(x, y).r, (-q0 + 3 * q1 - q2) / q, 1e-5);
      EXPECT_NEAR(image(x, y).g, (-q0 - q1 + 3 * q2) / q, 1e-5);
    }
}

}  // namespace
}  // namespace zoneplate
