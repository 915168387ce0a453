// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"
#include "zoneplate/scene/fit.h"

namespace zoneplate {

/// A built-in scene with its own camera, or else the whole of it, one sample a pixel, as it is shown: what filters of
/// images are timed on.
inline Rgba8Image scene_codes(const std::string& name, int width, int height) {
  Scene scene = *make_builtin_scene(name);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const Camera camera = scene.cameras.empty() ? fit_camera(scene.bounds(), aspect, {}) : scene.cameras[0];
  RenderOptions options;
  options.width = width, options.height = height;
  if (scene.lights.empty()) {
    scene.lights = default_lights();
    scene.environment.color = {default_environment, default_environment, default_environment};
  }
  return quantize8(make_display(render(PreparedScene(std::move(scene)), camera, Request{}, options).color,
                                {.background = {0.2f, 0.2f, 0.2f, 1}}));
}

}  // namespace zoneplate
