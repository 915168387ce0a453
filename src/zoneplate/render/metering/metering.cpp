// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/metering/metering.h"

#include <algorithm>
#include <utility>

#include "zoneplate/image/auto_exposure.h"

namespace zoneplate {

LinearImage metered_image(const PreparedScene& scene, const Camera& camera, RenderOptions options,
                          std::unique_ptr<Resolver> none) {
  constexpr int most_side = 256;
  options.crop.reset();
  options.background.reset();
  const int longest = std::max(options.width, options.height);
  if (longest > most_side) {
    options.width = std::max(1, options.width * most_side / longest);
    options.height = std::max(1, options.height * most_side / longest);
  }
  Renderer renderer(scene, std::move(none));
  return renderer.render(camera, {.options = options, .form = ImageForm::Linear}).linear;
}

bool is_well_above_white(float exposure, float metered) {
  constexpr float metered_white = 0.8f, most_light = 1.25f;  // the brightest surfaces' channel at the metered exposure
  return exposure * metered_white > most_light * metered;
}

LightDimming dimming_of(const PreparedScene& scene, const Camera& camera, const RenderOptions& options,
                        std::unique_ptr<Resolver> none) {
  if (!scene.scene().needs_fill_light) return {};
  const LinearImage image = metered_image(scene, camera, options, std::move(none));
  std::size_t surfaces = 0, white = 0;
  for (const Linear& c : image.values()) {
    if (c.a < 0.5f) continue;
    ++surfaces;
    white += std::min({c.r, c.g, c.b}) >= c.a;
  }
  const double part = static_cast<double>(white) / static_cast<double>(std::max<std::size_t>(surfaces, 1));
  const float metered = auto_exposure(image);
  if (part < least_white || !is_well_above_white(1, metered)) return {};
  return {metered, part};
}

PreparedScene dimmed(PreparedScene scene, float factor) {
  if (factor == 1) return scene;
  Lighting lighting = scene.lighting();
  for (Light& light : lighting.lights) light.intensity *= factor;
  return scene.lit(std::move(lighting));
}

}  // namespace zoneplate
