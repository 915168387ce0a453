// SPDX-License-Identifier: Apache-2.0
// Draws three meshes with shaders of their own into one image with one depth buffer: a textured floor, a lit ball that
// sinks into it, and a sheet of blue glass across both.
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "zoneplate/all.h"
using namespace zoneplate;

struct Floor {
  struct Varyings {
    float2 uv;
  };
  float4x4 clip_from_world;
  const Texture& texture;

  std::pair<float4, Varyings> vertex(const Vertex& vertex) const {
    const float x = vertex.index % 2 ? 6.0f : -6.0f, z = vertex.index / 2 ? -12.0f : 0.0f;
    return {clip_from_world * float4{x, -1, z, 1}, {{x / 2, z / 2}}};
  }
  float4 fragment(const Varyings& at, const Varyings& dx, const Varyings& dy) const {
    return sample(texture, {.anisotropy = 8}, at.uv, dx.uv, dy.uv);
  }
};

struct Ball {
  static constexpr std::uint32_t columns = 64, rows = 32;
  struct Varyings {
    float3 normal;
  };
  float4x4 clip_from_world;

  std::pair<float4, Varyings> vertex(const Vertex& vertex) const {
    constexpr float pi = 3.14159265f;
    const float longitude = 2 * pi * static_cast<float>(vertex.index % (columns + 1)) / static_cast<float>(columns);
    const float latitude = pi * static_cast<float>(vertex.index / (columns + 1)) / static_cast<float>(rows);
    const float3 n{std::sin(latitude) * std::cos(longitude), std::cos(latitude),
                   std::sin(latitude) * std::sin(longitude)};
    const float3 p = n + float3{0, -0.3f, -5};
    return {clip_from_world * float4{p.x, p.y, p.z, 1}, {n}};
  }
  float4 fragment(const Varyings& at, const Varyings& /*dx*/, const Varyings& /*dy*/) const {
    const float light = 0.15f + 0.85f * std::fmax(0.0f, dot(normalize(at.normal), normalize(float3{-1, 1, 1})));
    return {0.9f * light, 0.35f * light, 0.1f * light, 1};
  }
  static std::vector<std::uint32_t> indices() {
    std::vector<std::uint32_t> out;
    for (std::uint32_t row = 0; row < rows; ++row)
      for (std::uint32_t column = 0; column < columns; ++column) {
        const std::uint32_t a = row * (columns + 1) + column, b = a + columns + 1;
        out.insert(out.end(), {a, a + 1, b, b, a + 1, b + 1});
      }
    return out;
  }
};

struct Glass {
  struct Varyings {
    float height;
  };
  float4x4 clip_from_world;

  std::pair<float4, Varyings> vertex(const Vertex& vertex) const {
    const float x = vertex.index % 2 ? 2.0f : 0.1f, y = vertex.index / 2 ? 0.9f : -1.0f;
    return {clip_from_world * float4{x, y, -4.4f, 1}, {y}};
  }
  // Premultiplied: the colour is already multiplied by alpha.
  float4 fragment(const Varyings& at, const Varyings& /*dx*/, const Varyings& /*dy*/) const {
    const float alpha = 0.45f - 0.2f * at.height;
    return {0.1f * alpha, 0.3f * alpha, 0.8f * alpha, alpha};
  }
};

int main() {
  Rgba8Image checker(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      checker(x, y) = (x / 32 + y / 32) % 2 ? Rgba8{230, 225, 210, 255} : Rgba8{90, 100, 110, 255};
  const Texture texture(checker, TexelMeaning::Color);

  const int width = 640, height = 360;
  const Camera camera;  // at the origin, looking along -Z
  const float4x4 clip_from_world = camera.clip_from_camera(static_cast<float>(width) / height);
  const std::uint32_t quad[] = {0, 1, 2, 2, 1, 3};

  Canvas canvas(width, height, standard_pattern(8));
  canvas.draw(Glass{clip_from_world}, quad, 4, {.alpha_mode = AlphaMode::Blend});  // in any order
  canvas.draw(Floor{clip_from_world, texture}, quad, 4);
  canvas.draw(Ball{clip_from_world}, Ball::indices(), (Ball::columns + 1) * (Ball::rows + 1),
              {.culls_back_faces = true});
  save_image("several_shaders.png", quantize8(make_display(canvas.resolve(), {.background = {0.6f, 0.75f, 0.9f, 1}})));
}
