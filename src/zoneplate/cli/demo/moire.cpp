// Moire: what is too fine for the pixels comes back as something coarse that is not there.
#include <fmt/format.h>

#include <array>

#include "zoneplate/cli/demo/demo.h"
#include "zoneplate/cli/demo/picture.h"
#include "zoneplate/signal/filter/aliasing.h"
#include "zoneplate/signal/filter/resample.h"

namespace zoneplate::cli {
namespace {

constexpr int factor = 8;
constexpr const char *kernel_name = "lanczos3", *reference = "ssaa:n=16";

/// The checkerboard with its texture read as it lies: the nearest texel, no smaller levels.
Scene unfiltered(Scene scene) {
  for (Material& material : scene.materials)
    material.base_color_texture.sampler = {
        .magnify = TexelFilter::Nearest, .minify = TexelFilter::Nearest, .level = LevelFilter::None};
  return scene;
}

/// A picture, and a crop of it below.
struct Column {
  Panel above, below;
};
struct Place {
  int x, y;
};
Column column(const Rgba8Image& picture, Place crop, const std::string& caption, const char* below) {
  const int side = picture.width();
  return {{marked(picture, crop.x, crop.y, factor, side), caption},
          {crop_of(picture, crop.x, crop.y, factor, side), below}};
}

std::array<Column, 2> rings(int side) {
  const int whole = side + 2 * seam;
  const Plane<float> plate = zone_plate(2 * whole);
  const Kernel kernel = make_kernel(kernel_name);
  const AliasFigures figures = measure_aliases(plate, whole, whole, kernel);
  const Place place{side * 93 / 100, side / 2};
  return {column(shown(inside(resample_nearest(plate, whole, whole))), place,
                 "Rings, every second pixel taken\nThe rings grow finer outwards. There is one centre; the others are "
                 "moiré.",
                 "Where rings stand a pixel apart, the pixels show a slow wave that is not in the original."),
          column(shown(inside(resample(plate, whole, whole, kernel, {.border = Border::Wrap}))), place,
                 fmt::format("Rings, filtered first\nA {} filter, then every second pixel: aliases fall by {}\u00a0dB.",
                             kernel_name, number(-figures.all_db, 1)),
                 "What cannot be shown becomes an even grey: no detail, and no lie.")};
}

std::array<Column, 2> checks(int side) {
  const Scene board = scene_of("checkerboard");
  const LinearImage raw = shoot(unfiltered(board), "none", side, side), mapped = shoot(board, "none", side, side);
  const Plane<float> truth = luminance_of(shoot(unfiltered(board), reference, side, side));
  const auto error = [&](const LinearImage& light) {
    return number(100 * rms_difference(luminance_of(light), truth), 1);
  };
  const Place place{side * 30 / 100, side * 35 / 100};
  return {column(shown(raw), place,
                 fmt::format(
                     "Checks, one look a pixel\nTowards the horizon checks are smaller than pixels. Error: {}\u00a0% "
                     "of white.",
                     error(raw)),
                 "Arcs and blotches, and they swim when the camera moves."),
          column(shown(mapped), place,
                 fmt::format("Checks, filtered texture\nSmaller copies of the texture, averaged beforehand (mipmaps). "
                             "Error: {}\u00a0%.",
                             error(mapped)),
                 "The far field settles at the checks’ mean grey.")};
}

Lesson make(const DemoSize& size) {
  Figure figure{.title = "Moiré: what is too fine for the pixels returns as what is not there", .rows = {{}, {}}};
  for (const auto& columns : {rings(size.panel), checks(size.panel)})
    for (const Column& c : columns) figure.rows[0].push_back(c.above), figure.rows[1].push_back(c.below);
  figure.text =
      "Pixels hold no wave shorter than two of them. A wave of f > ½ cycles a pixel is not lost: it is seen at the "
      "distance of f from the nearest whole number. Filtering has to come before sampling; afterwards the false wave "
      "cannot be told from a true one. (Errors against 256 samples a pixel, root mean square of linear light.)";
  return {.frames = {figure}};
}

}  // namespace

Demo demo_moire() { return {"moire", "rings and checks too fine for the pixels, sampled and filtered", make}; }

}  // namespace zoneplate::cli
