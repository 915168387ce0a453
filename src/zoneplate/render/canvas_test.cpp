// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/canvas.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

/// A rectangle of one colour, from x0 to x1 over the whole height, at one depth.
struct Panel {
  float x0, x1, depth;
  float4 color;
  struct Varyings {
    float unused;
  };
  std::pair<float4, Varyings> vertex(const Vertex& v) const {
    return {{v.index % 2 ? x1 : x0, v.index / 2 ? 1.0f : -1.0f, depth, 1}, {0}};
  }
  float4 fragment(const Varyings&, const Varyings&, const Varyings&) const { return color; }
};

/// A panel whose colour is the place on the screen: a shader of another type, with more varyings.
struct Place {
  struct Varyings {
    float x, y;
  };
  std::pair<float4, Varyings> vertex(const Vertex& v) const {
    const float x = v.index % 2 ? 1.0f : -1.0f, y = v.index / 2 ? 1.0f : -1.0f;
    return {{x, y, 0.25f, 1}, {x, y}};
  }
  float4 fragment(const Varyings& u, const Varyings&, const Varyings&) const { return {u.x, u.y, 0, 1}; }
};

constexpr std::uint32_t quad[] = {0, 1, 2, 2, 1, 3};

TEST(Canvas, MeshesOfSeveralShadersShareDepth) {
  const Panel near{-1, 0, 0.5f, {0, 0, 1, 1}};
  for (const bool near_first : {false, true}) {
    Canvas canvas(16, 8);
    if (near_first) canvas.draw(near, quad, 4);
    canvas.draw(Place{}, quad, 4);
    if (!near_first) canvas.draw(near, quad, 4);
    const LinearImage image = canvas.resolve(), place = draw(Place{}, quad, 4, 16, 8);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x) EXPECT_EQ(image(x, y), x < 8 ? (Linear{0, 0, 1, 1}) : place(x, y)) << x << " " << y;
  }
}

TEST(Canvas, BlendedMeshesAreCompositedByDepth) {
  const Panel behind{-1, 1, 0.25f, {0.5f, 0, 0, 0.5f}}, in_front{-1, 1, 0.5f, {0, 0.25f, 0, 0.25f}};
  for (const bool front_first : {false, true}) {
    Canvas canvas(8, 8);
    canvas.draw(front_first ? in_front : behind, quad, 4, {.alpha_mode = AlphaMode::Blend});
    canvas.draw(front_first ? behind : in_front, quad, 4, {.alpha_mode = AlphaMode::Blend});
    EXPECT_EQ(canvas.resolve()(4, 4), (Linear{0.375f, 0.25f, 0, 0.625f}));
  }
}

TEST(Canvas, EachMeshHasItsOwnCulling) {
  Canvas canvas(8, 8);
  const std::uint32_t reversed[] = {0, 2, 1, 2, 3, 1};
  canvas.draw(Panel{-1, 1, 0.5f, {1, 0, 0, 1}}, reversed, 4, {.culls_back_faces = true});
  EXPECT_EQ(canvas.resolve()(4, 4), (Linear{0, 0, 0, 0}));
  canvas.draw(Panel{-1, 1, 0.25f, {0, 1, 0, 1}}, reversed, 4);
  EXPECT_EQ(canvas.resolve()(4, 4), (Linear{0, 1, 0, 1}));
}

}  // namespace
}  // namespace zoneplate
