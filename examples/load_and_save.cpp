// SPDX-License-Identifier: Apache-2.0
// Loads a model, renders it from the default view, and saves a PNG: load_and_save MODEL OUT.png
#include <cstdio>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
using namespace zoneplate;

int main(int argc, char** argv) try {
  if (argc != 3) return std::fprintf(stderr, "usage: load_and_save MODEL OUT.png\n"), 2;
  Scene scene = load_scene(argv[1]);
  light_unlit(scene);  // a model without lights gets default ones
  const Camera camera = choose_camera(scene, {.azimuth = 0.5f, .elevation = 0.35f}, 4.0f / 3);
  Renderer renderer(PreparedScene(std::move(scene)), make_resolver(antialias::methods(), "msaa:n=8"));
  const RenderedImage image = renderer.render(camera, {.options = {.width = 640, .height = 480}});
  save_image(argv[2], image.display);
} catch (const Error& error) {
  std::fprintf(stderr, "load_and_save: %s\n", error.what());
  return 1;
}
