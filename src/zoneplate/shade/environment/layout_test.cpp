// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/layout.h"

#include <gtest/gtest.h>

#include <cmath>


namespace zoneplate {
namespace {

/// Light by its direction: each channel is half the component, plus a half.
float4 light_from(float3 d) { return {0.5f + 0.5f * d.x, 0.5f + 0.5f * d.y, 0.5f + 0.5f * d.z, 1}; }

void expect_directions(const CubeImage& cube) {
  for (int face = 0; face < cube::faces; ++face)
    for (int y = 0; y < cube.side; y += 5)
      for (int x = 0; x < cube.side; x += 5) {
        const float3 d = normalize(cube::point(face, cube::centre(x, cube.side), cube::centre(y, cube.side)));
        const float3 found = cube.texels[cube.index(face, x, y)];
        const float4 expected = light_from(d);
        EXPECT_NEAR(found.x, expected.x, 0.02f) << face << ' ' << x << ' ' << y;
        EXPECT_NEAR(found.y, expected.y, 0.02f) << face << ' ' << x << ' ' << y;
        EXPECT_NEAR(found.z, expected.z, 0.02f) << face << ' ' << x << ' ' << y;
      }
}

/// The square of a cube map that is seen in the direction `ahead`, with `right` and `up` on the screen.
void paint(Plane<float4>& image, int left, int top, int side, float3 ahead, float3 right, float3 up) {
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float s = cube::centre(x, side), t = cube::centre(y, side);
      image(left + x, top + y) = light_from(normalize(ahead + right * s - up * t));
    }
}

TEST(EnvironmentLayout, IsKnownByTheAspect) {
  EXPECT_EQ(layout_of(1024, 512), EnvironmentLayout::Equirectangular);
  EXPECT_EQ(layout_of(640, 480), EnvironmentLayout::Cross);
  EXPECT_EQ(layout_of(480, 640), EnvironmentLayout::Cross);
  EXPECT_EQ(layout_of(600, 100), EnvironmentLayout::Strip);
  EXPECT_EQ(layout_of(100, 600), EnvironmentLayout::Strip);
  EXPECT_EQ(layout_of(500, 500), EnvironmentLayout::MirrorBall);
}

TEST(EnvironmentLayout, AnEquirectangularImageGivesItsDirections) {
  Plane<float4> image(128, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x) {
      const double u = (x + 0.5) / 128 * 2 * M_PI, v = (y + 0.5) / 64 * M_PI;
      image(x, y) = light_from({static_cast<float>(-std::cos(u) * std::sin(v)), static_cast<float>(std::cos(v)),
                                static_cast<float>(-std::sin(u) * std::sin(v))});
    }
  expect_directions(cube_of(TexelImage(image), EnvironmentLayout::Equirectangular));
}

TEST(EnvironmentLayout, ACrossIsThePanoramaSeenFromInside) {
  // From the middle, +z, to the right: -x, -z, +x; above +y and below -y, seen with the head back and forth.
  constexpr int side = 32;
  const float3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Plane<float4> wide(4 * side, 3 * side), tall(3 * side, 4 * side);
  for (Plane<float4>* image : {&wide, &tall}) {
    paint(*image, side, side, side, z, -x, y);
    paint(*image, 2 * side, side, side, -x, -z, y);
    paint(*image, 0, side, side, x, z, y);
    paint(*image, side, 0, side, y, -x, -z);
    paint(*image, side, 2 * side, side, -y, -x, z);
  }
  paint(wide, 3 * side, side, side, -z, x, y);
  paint(tall, side, 3 * side, side, -z, -x, -y);
  expect_directions(cube_of(TexelImage(wide), EnvironmentLayout::Cross));
  expect_directions(cube_of(TexelImage(tall), EnvironmentLayout::Cross));

  Plane<float4> strip(6 * side, side);
  const Plane<float4>& cross = wide;
  const int2 squares[] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
  for (int k = 0; k < 6; ++k)
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column)
        strip(k * side + column, row) = cross(squares[k].x * side + column, squares[k].y * side + row);
  expect_directions(cube_of(TexelImage(strip), EnvironmentLayout::Strip));
}

TEST(EnvironmentLayout, ProbesGiveTheirDirections) {
  constexpr int side = 512;
  Plane<float4> ball(side, side), angular(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float s = cube::centre(x, side), t = -cube::centre(y, side), r = std::sqrt(s * s + t * t);
      const float nz = std::sqrt(std::max(0.0f, 1 - r * r));
      ball(x, y) = light_from({2 * nz * s, 2 * nz * t, 2 * nz * nz - 1});
      const float sine = std::sin(3.14159265f * std::min(r, 1.0f));
      angular(x, y) = light_from({sine * s / r, sine * t / r, -std::cos(3.14159265f * std::min(r, 1.0f))});
    }
  const CubeImage by_angle = cube_of(TexelImage(angular), EnvironmentLayout::AngularMap);
  const CubeImage by_ball = cube_of(TexelImage(ball), EnvironmentLayout::MirrorBall);
  for (const CubeImage* cube : {&by_angle, &by_ball})
    for (int face = 0; face < cube::faces; ++face)
      for (int k = 0; k < cube->side; k += 7) {
        const float3 d = normalize(cube::point(face, cube::centre(k, cube->side), cube::centre(k / 2, cube->side)));
        // All around the rim is one direction: the back of the ball, the front of the angular map.
        if ((cube == &by_ball ? -d.z : d.z) > 0.97f) continue;
        const float3 found = cube->texels[cube->index(face, k, k / 2)];
        EXPECT_NEAR(found.x, light_from(d).x, 0.03f) << face << ' ' << k;
        EXPECT_NEAR(found.y, light_from(d).y, 0.03f) << face << ' ' << k;
        EXPECT_NEAR(found.z, light_from(d).z, 0.03f) << face << ' ' << k;
      }
}

}  // namespace
}  // namespace zoneplate
