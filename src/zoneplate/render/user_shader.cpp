// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/user_shader.h"

#include "zoneplate/raster/tile/rasterize.h"

namespace zoneplate {

LinearImage draw_triangles(std::span<const float4> clip, std::span<const std::uint32_t> indices,
                           const FragmentShader& shader, int width, int height, const DrawOptions& options) {
  Draw draw;
  draw.clip = clip;
  draw.index = indices;
  draw.alpha_mode = options.alpha_mode;
  draw.culls_back_faces = options.culls_back_faces;

  LinearImage image(width, height, Linear{0, 0, 0, 0});
  Target target;
  target.viewport = {width, height};
  target.width = width, target.height = height;
  target.samples = options.samples;
  target.is_per_sample = options.is_per_sample;
  target.color = &image;
  rasterize(std::span(&draw, 1), shader, {}, target);
  return image;
}

}  // namespace zoneplate
