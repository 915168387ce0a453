// Moire: what is too fine for the pixels comes back as something coarse that is not there.
#include <fmt/format.h>

#include "zoneplate/cli/demo.h"
#include "zoneplate/cli/demo_picture.h"
#include "zoneplate/signal/aliasing.h"
#include "zoneplate/signal/resample.h"

namespace zoneplate::cli {
namespace {

constexpr int factor = 8;
constexpr const char* kernel_name = "lanczos3";

/// The checkerboard with its texture read as it lies: the nearest texel, no smaller levels.
Scene unfiltered(Scene scene) {
  for (Material& material : scene.materials)
    material.base_color_texture.sampler = {
        .magnify = TexelFilter::Nearest, .minify = TexelFilter::Nearest, .level = LevelFilter::None};
  return scene;
}

Lesson make(const DemoSize& size) {
  const int side = size.panel;
  const Plane<float> plate = zone_plate(2 * side);
  const Kernel kernel = make_kernel(kernel_name);
  const Rgba8Image naive = shown(resample_nearest(plate, side, side));
  const Rgba8Image filtered = shown(resample(plate, side, side, kernel, {.border = Border::Wrap}));
  const AliasFigures figures = measure_aliases(plate, side, side, kernel);

  const Scene board = scene_of("checkerboard");
  const LinearImage raw = shoot(unfiltered(board), "none", side, side), mapped = shoot(board, "none", side, side);
  const LinearImage truth = shoot(unfiltered(board), "ssaa:n=16", side, side);
  const auto error = [&](const LinearImage& light) {
    return number(100 * rms_difference(luminance_of(light), luminance_of(truth)), 1);
  };

  const int ring_x = side * 93 / 100, ring_y = side / 2, far_x = side * 30 / 100, far_y = side * 35 / 100;
  const auto panels = [&](const Rgba8Image& picture, int x, int y, const std::string& caption, const char* below) {
    return std::pair<Panel, Panel>{{marked(picture, x, y, factor, side), caption},
                                   {crop_of(picture, x, y, factor, side), below}};
  };
  const std::pair<Panel, Panel> columns[] = {
      panels(naive, ring_x, ring_y,
             "Rings, every second pixel taken\nThe rings grow finer outwards. There is one centre; the others are "
             "moiré.",
             "Where a ring is as wide as a pixel, the pixels show a slow wave that is not in the original."),
      panels(filtered, ring_x, ring_y,
             fmt::format("Rings, filtered first\nA {} filter, then every second pixel: aliases fall by {} dB.",
                         kernel_name, number(-figures.all_db, 1)),
             "What cannot be shown becomes an even grey: no detail, and no lie."),
      panels(shown(raw), far_x, far_y,
             fmt::format("Checks, one look a pixel\nTowards the horizon checks are smaller than pixels. Error: {} % of "
                         "white.",
                         error(raw)),
             "Arcs and blotches, and they swim when the camera moves."),
      panels(shown(mapped), far_x, far_y,
             fmt::format("Checks, filtered texture\nSmaller copies of the texture, averaged beforehand (mipmaps). "
                         "Error: {} %.",
                         error(mapped)),
             "The far field settles at the checks’ mean grey.")};
  Figure figure{.title = "Moiré: what is too fine for the pixels returns as what is not there", .rows = {{}, {}}};
  for (const auto& [above, below] : columns) figure.rows[0].push_back(above), figure.rows[1].push_back(below);
  figure.text = fmt::format(
      "Pixels hold no wave shorter than two of them. A wave of f > ½ cycles a pixel is not lost: it is seen at the "
      "distance of f from the nearest whole number. Filtering has to come before sampling; afterwards the false wave "
      "cannot be told from a true one. (Errors against 256 samples a pixel, root mean square of linear light.)");
  return {.frames = {figure}};
}

}  // namespace

Demo demo_moire() { return {"moire", "rings and checks too fine for the pixels, sampled and filtered", make}; }

}  // namespace zoneplate::cli
