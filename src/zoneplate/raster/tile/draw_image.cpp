// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/draw_image.h"

#include "zoneplate/raster/tile/rasterize.h"

namespace zoneplate {

LinearImage draw_image(std::span<const Draw> draws, const FragmentShader& shader, int width, int height,
                       const SamplePattern& samples, bool is_per_sample) {
  LinearImage image(width, height, Linear{0, 0, 0, 0});
  Target target;
  target.viewport = {width, height};
  target.width = width, target.height = height;
  target.samples = samples;
  target.is_per_sample = is_per_sample;
  target.color = &image;
  rasterize(draws, shader, {}, target);
  return image;
}

}  // namespace zoneplate
