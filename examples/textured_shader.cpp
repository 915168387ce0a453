// SPDX-License-Identifier: Apache-2.0
// Draws a textured floor in perspective with a shader of its own.
#include "zoneplate/codec/save.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/user_shader.h"
#include "zoneplate/scene/camera.h"
#include "zoneplate/shade/texture/sample.h"
using namespace zoneplate;

struct Floor {
  struct Varyings {  // floats only; the rasterizer interpolates them with perspective correction
    float u, v;
  };
  float4x4 clip_from_world;
  const Texture& texture;
  Sampler sampler{.anisotropy = 8};

  std::pair<float4, Varyings> vertex(const Vertex& vertex) const {
    const float x = vertex.index % 2 ? 20.0f : -20.0f, z = vertex.index / 2 ? -60.0f : 0.0f;
    return {clip_from_world * float4{x, -1, z, 1}, {x / 4, z / 4}};
  }
  // dx and dy are the changes of the varyings per pixel to the right and downwards: the footprint of the texture.
  float4 fragment(const Varyings& at, const Varyings& dx, const Varyings& dy) const {
    return sample(texture, sampler, {at.u, at.v}, {dx.u, dx.v}, {dy.u, dy.v});
  }
};

int main() {
  Rgba8Image checker(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      checker(x, y) = (x / 32 + y / 32) % 2 ? Rgba8{230, 225, 210, 255} : Rgba8{40, 60, 90, 255};
  const Texture texture(checker, TexelMeaning::Color);

  const int width = 640, height = 360;
  const Camera camera;  // at the origin, looking along -Z
  const Floor floor{.clip_from_world = camera.clip_from_camera(static_cast<float>(width) / height), .texture = texture};
  const std::uint32_t indices[] = {0, 1, 2, 2, 1, 3};
  const LinearImage image = draw(floor, indices, 4, width, height, {.samples = standard_pattern(8)});
  save_image("floor.png", quantize8(make_display(image, {.background = {0.6f, 0.75f, 0.9f, 1}})));
}
