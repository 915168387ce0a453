// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/environment_background.h"

#include <algorithm>

#include "zoneplate/base/parallel.h"
#include "zoneplate/shade/environment/lookup.h"
#include "zoneplate/shade/environment/prepared_environment.h"

namespace zoneplate {
namespace {

constexpr int block = 64;

/// The direction in which a camera looks through the point (x, y) of the image, in pixels: first + x dx + y dy.
struct Outlook {
  float3 first, dx, dy;
};

Outlook outlook_of(const Camera& camera, const RenderOptions& options) {
  const float width = static_cast<float>(options.width), height = static_cast<float>(options.height);
  const float4x4& world = camera.world_from_camera;
  const float3 right = xyz(world.column[0]), up = xyz(world.column[1]), back = xyz(world.column[2]);
  if (camera.is_orthographic) return {-back, {0, 0, 0}, {0, 0, 0}};
  const float4x4 clip = camera.clip_from_camera(aspect_of(options));
  const float tan_x = 1 / clip.column[0].x, tan_y = 1 / clip.column[1].y;
  return {right * ((clip.column[2].x - 1) * tan_x) + up * ((clip.column[2].y + 1) * tan_y) - back,
          right * (2 * tan_x / width), up * (-2 * tan_y / height)};
}

Linear over(Linear front, float3 light) {
  const float rest = std::max(1 - front.a, 0.0f);
  return {front.r + light.x * rest, front.g + light.y * rest, front.b + light.z * rest, 1};
}

}  // namespace

void draw_environment(const Environment& environment, float3 up, const Camera& camera, const RenderOptions& options,
                      LinearImage& image) {
  if (!environment.map) {
    for (Linear& pixel : image.values()) pixel = over(pixel, environment.factor());
    return;
  }
  const EnvironmentView view = environment.map->view(environment, up, camera.world_from_camera);
  const LookupKernels& kernels = LookupKernels::of();
  const Outlook outlook = outlook_of(camera, options);
  const float roughness = options.background ? options.background->blur : 0;
  const int left = options.crop ? options.crop->x : 0, top = options.crop ? options.crop->y : 0;
  parallel_for(static_cast<std::size_t>(image.height()), [&](std::size_t row) {
    const auto pixels = image.row(static_cast<int>(row));
    const float y = static_cast<float>(top + static_cast<int>(row)) + 0.5f;
    const float3 start = outlook.first + outlook.dy * y;
    alignas(64) float direction[3][block], light[3][block];
    for (int begin = 0; begin < image.width(); begin += block) {
      for (int i = 0; i < block; ++i) {
        const float3 d = start + outlook.dx * (static_cast<float>(left + begin + i) + 0.5f);
        direction[0][i] = d.x, direction[1][i] = d.y, direction[2][i] = d.z;
      }
      const float* const from[3] = {direction[0], direction[1], direction[2]};
      float* const to[3] = {light[0], light[1], light[2]};
      kernels.specular(view, from, roughness, to, block);
      for (int i = 0; i < std::min(block, image.width() - begin); ++i) {
        Linear& pixel = pixels[static_cast<std::size_t>(begin + i)];
        pixel = over(pixel, {light[0][i], light[1][i], light[2][i]});
      }
    }
  });
}

}  // namespace zoneplate
