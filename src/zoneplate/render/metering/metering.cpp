// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/metering/metering.h"

#include <algorithm>
#include <utility>

#include "zoneplate/image/auto_exposure.h"
#include "zoneplate/render/view.h"

namespace zoneplate {
namespace {

constexpr int max_side = 256;

bool is_white(const Linear& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b >= c.a; }

/// The part of an image's surfaces whose luminance is clipped; those of `unlit` that are so themselves do not count.
double clipped_part(const LinearImage& lit, const LinearImage* unlit = nullptr) {
  std::size_t surfaces = 0, white = 0;
  for (std::size_t i = 0; i < lit.values().size(); ++i) {
    const Linear& c = lit.values()[i];
    if (c.a < 0.5f) continue;
    ++surfaces, white += is_white(c) && (unlit == nullptr || !is_white(unlit->values()[i]));
  }
  return static_cast<double>(white) / static_cast<double>(std::max<std::size_t>(surfaces, 1));
}

/// The dimming by an image of a scene and one without its lights, which emission and the fill light make.
LightDimming dimming_by(const LinearImage& lit, const LinearImage& unlit) {
  LinearImage lights = lit;
  for (std::size_t i = 0; i < lit.values().size(); ++i) {
    Linear& c = lights.values()[i];
    const Linear& own = unlit.values()[i];
    c = {c.r - own.r, c.g - own.g, c.b - own.b, c.a};
  }
  const double part = clipped_part(lit, &unlit);
  const float metered = auto_exposure(lights);
  if (part < min_white || !is_well_above_white(1, metered)) return {};
  return {metered, part};
}

}  // namespace

LinearImage metered_image(Renderer& renderer, const Camera& camera, RenderOptions options) {
  options.crop.reset();
  options.background.reset();
  options.edges = {};
  const int longest = std::max(options.width, options.height);
  if (longest > max_side) {
    options.width = std::max(1, options.width * max_side / longest);
    options.height = std::max(1, options.height * max_side / longest);
  }
  return renderer.render(camera, {.options = options, .form = ImageForm::Linear}).linear;
}

bool is_well_above_white(float exposure, float metered) {
  constexpr float metered_white = 0.8f, max_light = 1.25f;  // the brightest surfaces' channel at the metered exposure
  return exposure * metered_white > max_light * metered;
}

LightDimming dimming_of(const PreparedScene& prepared, std::unique_ptr<Resolver> none) {
  const Scene& scene = prepared.scene();
  if (!scene.needs_fill_light) return {};
  Renderer renderer(prepared, std::move(none));
  LightDimming least;
  const auto meter = [&](const View& view) {
    const Camera camera = choose_camera(scene, view, 1);
    const RenderOptions options{.width = max_side, .height = max_side};
    renderer.set_scene(prepared);
    const LinearImage lit = metered_image(renderer, camera, options);
    // The image without lights can only lower the part that they clip.
    if (clipped_part(lit) < min_white) return;
    renderer.set_scene(dimmed(prepared, 0));
    const LightDimming found = dimming_by(lit, metered_image(renderer, camera, options));
    if (found.factor < least.factor) least = found;
  };
  meter({.up = scene.up});
  if (!scene.cameras.empty()) meter({.index = 0, .up = scene.up});
  return least;
}

PreparedScene dimmed(PreparedScene scene, float factor) {
  if (factor == 1) return scene;
  Lighting lighting = scene.lighting();
  for (Light& light : lighting.lights) light.intensity *= factor;
  return scene.lit(std::move(lighting));
}

}  // namespace zoneplate
