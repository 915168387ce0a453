// SPDX-License-Identifier: Apache-2.0
// The five shaders of a rasterization course's third homework (GAMES101, "Pipeline and Shading"), on its model with its
// constants: light is computed in camera space, but the lights and the eye of the highlights keep their world
// coordinates, as in the course's program. course_shaders MODEL [COLORS.png [HEIGHTS.png]] writes normal.png,
// phong.png, texture.png, bump.png and displacement.png; the arguments of the course are spot_triangulated_good.obj,
// spot_texture.png and hmap.jpg as a PNG.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/user_shader.h"
#include "zoneplate/scene/camera.h"
#include "zoneplate/shade/texture/sample.h"
using namespace zoneplate;

enum class Kind { Normal, Phong, Texture, Bump, Displacement };

constexpr float ka = 0.005f, ks = 0.7937f, exponent = 150, kh = 0.2f, kn = 0.1f;
constexpr float3 eye{0, 0, 10}, ambient_light{10, 10, 10};
struct PointLight {
  float3 position, intensity;
};
constexpr PointLight lights[] = {{{20, 20, 20}, {500, 500, 500}}, {{-20, 20, 0}, {500, 500, 500}}};

// Ambient, diffuse and specular light of Blinn and Phong, with a falloff of 1 / r².
float3 blinn_phong(float3 point, float3 n, float3 kd) {
  float3 sum{};
  for (const PointLight& light : lights) {
    const float3 way = light.position - point;
    const float3 arriving = light.intensity * (1 / dot(way, way));
    const float3 l = normalize(way), v = normalize(eye - point), h = normalize(l + v);
    sum = sum + ambient_light * ka + kd * arriving * std::max(0.0f, dot(n, l)) +
          arriving * (ks * std::pow(std::max(0.0f, dot(n, h)), exponent));
  }
  return sum;
}

struct CourseShader {
  struct Varyings {
    float x, y, z, nx, ny, nz, u, v;
  };
  Kind kind;
  const Mesh& mesh;
  const Rgba8Image& heights;
  const Texture& color_texture;
  const Texture& height_texture;
  float4x4 camera_from_object, clip_from_camera;

  std::pair<float4, Varyings> vertex(const Vertex& vertex) const {
    const auto i = static_cast<std::size_t>(vertex.index);
    const float3 p = mesh.position[i], n = mesh.normal[i];
    const float4 at = camera_from_object * float4{p.x, p.y, p.z, 1};
    const float4 normal = normal_matrix(camera_from_object) * float4{n.x, n.y, n.z, 0};
    const float2 uv = mesh.uv0.empty() ? float2{} : mesh.uv0[i];
    return {clip_from_camera * at, {at.x, at.y, at.z, normal.x, normal.y, normal.z, uv.x, uv.y}};
  }

  // Stored values in [0, 1], bilinear.
  static float3 look_up(const Texture& texture, float u, float v) {
    return xyz(sample(texture, {.level = LevelFilter::None}, {u, v}, {}, {}));
  }
  // The height is the length of the colour vector in 8-bit values.
  float height_at(float u, float v) const { return 255 * length(look_up(height_texture, u, v)); }

  // The normal perturbed by the height's differences of one texel, in the course's tangent frame. The course's v grows
  // upwards, the library's downwards.
  float3 bumped(float3 n, float u, float v) const {
    const float across = std::sqrt(n.x * n.x + n.z * n.z);
    const float3 t{n.x * n.y / across, across, n.z * n.y / across}, b = cross(n, t);
    const float du = kh * kn * (height_at(u + 1 / static_cast<float>(heights.width()), v) - height_at(u, v));
    const float dv = kh * kn * (height_at(u, v - 1 / static_cast<float>(heights.height())) - height_at(u, v));
    return normalize(t * -du + b * -dv + n);
  }

  float3 shade(const Varyings& at) const {
    const float3 point{at.x, at.y, at.z}, n = normalize(float3{at.nx, at.ny, at.nz});
    const float3 kd = float3{148, 121, 92} * (1 / 255.0f);
    switch (kind) {
      case Kind::Normal:
        return (n + float3{1, 1, 1}) * 0.5f;
      case Kind::Phong:
        return blinn_phong(point, n, kd);
      case Kind::Texture:
        return blinn_phong(point, n, look_up(color_texture, at.u, at.v));
      case Kind::Bump:
        return bumped(n, at.u, at.v);
      case Kind::Displacement:
        return blinn_phong(point + n * (kn * height_at(at.u, at.v)), bumped(n, at.u, at.v), kd);
    }
    return {};
  }
  float4 fragment(const Varyings& at, const Varyings& /*dx*/, const Varyings& /*dy*/) const {
    const float3 c = shade(at);
    const auto clamped = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
    return {clamped(c.x), clamped(c.y), clamped(c.z), 1};
  }
};

// The pixels of a PNG; the course's brown where no file is given.
Rgba8Image read_image(const char* path) {
  if (path == nullptr) return Rgba8Image(1, 1, {148, 121, 92, 255});
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  return decode_png(bytes, path).pixels;
}

int main(int argc, char** argv) try {
  if (argc < 2 || argc > 4) return std::fprintf(stderr, "usage: course_shaders MODEL [COLORS.png [HEIGHTS.png]]\n"), 2;
  const Scene scene = load_scene(argv[1]);
  const Mesh& mesh = scene.meshes.front();
  const Rgba8Image colors = read_image(argc > 2 ? argv[2] : nullptr);
  const Rgba8Image heights = argc > 3 ? read_image(argv[3]) : colors;
  const Texture color_texture(colors, TexelMeaning::Values), height_texture(heights, TexelMeaning::Values);

  constexpr float degree = 3.14159265f / 180;
  Camera camera;
  camera.vertical_fov = 45 * degree;
  const float4x4 camera_from_object =
      translation(-eye) * rotation({0, 1, 0}, 140 * degree) * scaling({2.5f, 2.5f, 2.5f});
  constexpr std::pair<Kind, const char*> pictures[] = {{Kind::Normal, "normal.png"},
                                                       {Kind::Phong, "phong.png"},
                                                       {Kind::Texture, "texture.png"},
                                                       {Kind::Bump, "bump.png"},
                                                       {Kind::Displacement, "displacement.png"}};
  for (const auto& [kind, name] : pictures) {
    const CourseShader shader{
        kind, mesh, heights, color_texture, height_texture, camera_from_object, camera.clip_from_camera(1)};
    const LinearImage image = draw(shader, mesh.index, static_cast<std::uint32_t>(mesh.position.size()), 700, 700);
    save_image(name, quantize8(make_display(image, {.raw = true})));  // clamped and without gamma, as in the course
  }
} catch (const Error& error) {
  std::fprintf(stderr, "course_shaders: %s\n", error.what());
  return 1;
}
