// SPDX-License-Identifier: Apache-2.0
// Upscalers at equal cost: every image is made of a quarter of its pixels per frame.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/image/transfer.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/metrics/mse.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::lessons {
namespace upscaling_lesson {
namespace {

constexpr int factor = 8;
constexpr std::size_t columns = 5;

struct Step {
  const char *method, *words;
};
constexpr std::array<Step, 9> steps = {
    {{"smaa+bilinear:scale=2", "The mean of four pixels: soft, and diagonals show the grid of the small image."},
     {"smaa+bicubic:scale=2", "Negative weights sharpen edges, with pale and dark seams beside them."},
     {"smaa+lanczos:scale=2", "Six pixels along each axis: sharper, with more seams."},
     {"smaa+sgsr1:scale=2", "Twelve pixels of green, weighed along the edge, correct the bilinear image."},
     {"smaa+nis:scale=2", "Filters along four directions, and sharpening of luma."},
     {"smaa+fsr1:scale=2",
      "A kernel that is turned and stretched along the edge, clamped to its neighbours; sharpened."},
     {"taau:scale=2", "The mean of 32 jittered frames of that size: of all samples, by their distance."},
     {"fsr2:scale=2", "The same frames; details that history has and a frame lacks are locked."},
     {"fsr3:scale=2", "The same frames; history is kept where its luma is stable, and is softer at first."}}};

struct Shot {
  DisplayImage image;
  std::uint64_t shaded;  // per frame
};

Shot shot(const PreparedScene& scene, const Camera& camera, const std::string& method, int side, int height) {
  Renderer renderer(scene, upscale::make_method(method));
  RenderSettings settings{.options = {.width = side, .height = height}, .form = ImageForm::Display16};
  settings.options.display.background = default_background;
  const int frames = method.starts_with("fsr2") || method.starts_with("fsr3") || method.starts_with("taau") ? 32 : 1;
  RenderedImage image;
  for (int i = 0; i < frames; ++i) image = renderer.render(camera, settings);
  DisplayImage out(side, height);
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    const Rgba16 c = image.display16.values()[i];
    const auto value = [](std::uint16_t code) { return static_cast<float>(code) / 65535; };
    out.values()[i] = {value(c.r), value(c.g), value(c.b), 1};
  }
  return {std::move(out), image.counts.shaded};
}

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, height = side * 3 / 4;
  Scene scene = scene_of("teapot");
  const Camera camera = camera_of(scene, side, height);
  light_unlit(scene);
  const PreparedScene prepared(std::move(scene));
  const Shot reference = shot(prepared, camera, "ssaa:n=8", side, height);

  // The right end of the lid and its seat: outlines, a seam, and highlights narrower than a pixel.
  const int x = side * 57 / 100, y = side * 20 / 100;
  Figure figure{.title = "Upscaling: images of 2 × 2 pixels for each shaded one", .rows = {{}, {}, {}, {}}};
  const auto add = [&](std::size_t i, const Shot& each, std::string caption, std::string crop_caption) {
    const Rgba8Image picture = quantize8(each.image);
    figure.rows[i / columns * 2].push_back({marked(picture, x, y, factor, side), std::move(caption)});
    figure.rows[i / columns * 2 + 1].push_back({crop_of(picture, x, y, factor, side), std::move(crop_caption)});
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Shot each = shot(prepared, camera, steps[i].method, side, height);
    const double error = std::sqrt(metrics::mean_squared_error(reference.image, each.image));
    add(i, each, fmt::format("{}\n{}", steps[i].method, steps[i].words),
        fmt::format("{} shaded samples a frame, error {}\u00a0%.", counted(each.shaded), number(100 * error, 2)));
  }
  add(steps.size(), reference, "ssaa:n=8\nThe reference.",
      fmt::format("{} shaded samples.", counted(reference.shaded)));
  figure.text =
      "The frames mark the regions below, enlarged 8 times. Error: root mean square difference from the reference, of "
      "sRGB values, white being 100 %. Filters of one image guess what lies between its pixels: they keep edges sharp, "
      "and cannot bring back a highlight that no sample has hit. The temporal methods, taau, fsr2 and fsr3, sample "
      "another "
      "place of each pixel in every frame. The filters are defined for antialiased images; here smaa precedes them.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace upscaling_lesson

Demo demo_upscaling() {
  return {"upscaling", "nine upscalers of images with a quarter of the pixels", upscaling_lesson::make};
}

}  // namespace zoneplate::lessons
