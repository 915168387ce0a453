// SPDX-License-Identifier: Apache-2.0
// An antialiasing method defined outside the library: rotated-grid supersampling and a vignette of the finished image.
// Its catalogue is used together with that of the library.
#include <cmath>
#include <cstdio>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
using namespace zoneplate;

/// Four samples per pixel at the corners of a square rotated by 26.6 degrees, each shaded by itself.
class RotatedGrid : public Resolver {
 public:
  explicit RotatedGrid(int strength) : strength_(static_cast<float>(strength) / 100) {}

  // The renderer draws what the request describes; the tiles compute the weighted mean of the samples.
  Request request(const FrameContext&) override {
    return {.samples = {{96, 32}, {224, 96}, {32, 160}, {160, 224}},  // 1/256 pixel from the pixel's corner
            .rate = Rate::Sample};
  }

  // Called with the display-referred image: sRGB values in [0, 1], straight alpha.
  DisplayImage post_process(DisplayImage image, const Frame&) override {
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) {
        const float dx = 2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(image.width()) - 1;
        const float dy = 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height()) - 1;
        const float weight = 1 - strength_ * 0.5f * (dx * dx + dy * dy);
        Display& c = image(x, y);
        c.r *= weight, c.g *= weight, c.b *= weight;
      }
    return image;
  }

 private:
  float strength_;
};

constexpr Param params[] = {
    {.name = "vignette", .meaning = "darkening of the corners, in percent", .value = 40, .high = 100}};
const Method catalogue[] = {{.name = "rotated-grid",
                             .summary = "four rotated samples and a vignette",
                             .source = "this example",
                             .params = params,
                             .make = [](const Settings& settings) -> std::unique_ptr<Resolver> {
                               return std::make_unique<RotatedGrid>(settings.integer("vignette"));
                             }}};

int main() {
  Scene scene = load_scene("teapot");
  light_unlit(scene);
  const Camera camera = choose_camera(scene, {}, 4.0f / 3);
  Renderer renderer(PreparedScene(std::move(scene)), make_resolver(catalogue, "rotated-grid:vignette=60"));
  const RenderedImage image = renderer.render(camera, {.options = {.width = 400, .height = 300}});
  save_image("own_method.png", image.display);
}
