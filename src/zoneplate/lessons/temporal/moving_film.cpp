// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/lessons/temporal/moving_film.h"

#include <fmt/format.h>

#include <optional>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate::lessons {

std::vector<LinearImage> film_of_scene(const std::string& scene, const std::string& method, int frames, int width,
                                       int height) {
  return film_of_scene(scene, make_resolver(antialias::methods(), method), frames, width, height);
}

std::vector<LinearImage> film_of_scene(const std::string& scene, std::unique_ptr<Resolver> method, int frames,
                                       int width, int height) {
  constexpr double rate = 24;
  const RenderSettings settings{.options = {.width = width, .height = height}, .form = ImageForm::Linear};
  std::optional<Renderer> renderer;
  std::vector<LinearImage> film;
  for (int i = 0; i < frames; ++i) {
    Scene now = scene_of(fmt::format("{}:time={:.6f}", scene, i / rate));
    light_unlit(now);
    const Camera camera = camera_of(now, width, height);
    if (renderer)
      renderer->set_scene(PreparedScene(std::move(now), renderer->scene()));
    else
      renderer.emplace(PreparedScene(std::move(now)), std::move(method));
    film.push_back(renderer->render(camera, settings).linear);
  }
  return film;
}

}  // namespace zoneplate::lessons
