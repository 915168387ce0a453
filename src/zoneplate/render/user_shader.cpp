// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/user_shader.h"

#include "zoneplate/raster/tile/draw_image.h"

namespace zoneplate {

LinearImage draw_triangles(std::span<const float4> clip, std::span<const std::uint32_t> indices,
                           const FragmentShader& shader, int width, int height, const DrawOptions& options) {
  Draw draw;
  draw.clip = clip;
  draw.index = indices;
  draw.alpha_mode = options.alpha_mode;
  draw.culls_back_faces = options.culls_back_faces;
  return draw_image(std::span(&draw, 1), shader, width, height, options.samples, options.is_per_sample);
}

}  // namespace zoneplate
