// SPDX-License-Identifier: Apache-2.0
// Moire: detail too fine for the pixels appears as a false coarse pattern.
#include <fmt/format.h>

#include <array>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/signal/filter/aliasing.h"
#include "zoneplate/signal/filter/resample.h"

namespace zoneplate::lessons {
namespace moire_lesson {
namespace {

constexpr int factor = 8;
constexpr const char *kernel_name = "lanczos3", *reference = "ssaa:n=16";

/// The checkerboard with nearest-texel filtering and without mip levels.
Scene unfiltered(Scene scene) {
  for (Material& material : scene.materials)
    material.base_color_texture.sampler = {
        .magnify = TexelFilter::Nearest, .minify = TexelFilter::Nearest, .level = LevelFilter::None};
  return scene;
}

/// An image, and a crop of it below.
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
                 "Rings, every second pixel\nThe rings become finer outwards. Only one centre is real; the others are "
                 "moiré.",
                 "Where rings are a pixel apart, the samples form a low frequency that is not in the original."),
          column(shown(inside(resample(plate, whole, whole, kernel, {.border = Border::Wrap}))), place,
                 fmt::format("Rings, filtered first\nA {} filter, then every second pixel: aliases fall by {}\u00a0dB.",
                             kernel_name, number(-figures.all_db, 1)),
                 "Frequencies above the Nyquist limit become a uniform grey, without moiré.")};
}

std::array<Column, 2> checks(int side) {
  const Scene board = scene_of("checkerboard");
  const LinearImage raw = shoot(unfiltered(board), "none", side, side), mapped = shoot(board, "none", side, side);
  const Plane<float> exact = luminance_of(shoot(unfiltered(board), reference, side, side));
  const auto error = [&](const LinearImage& light) {
    return number(100 * rms_difference(luminance_of(light), exact), 1);
  };
  const Place place{side * 30 / 100, side * 35 / 100};
  return {
      column(shown(raw), place,
             fmt::format(
                 "Checks, one sample per pixel\nTowards the horizon checks are smaller than pixels. Error: {}\u00a0% "
                 "of white.",
                 error(raw)),
             "Arcs and blotches, which flicker when the camera moves."),
      column(shown(mapped), place,
             fmt::format("Checks, filtered texture\nReduced copies of the texture, averaged in advance (mipmaps). "
                         "Error: {}\u00a0%.",
                         error(mapped)),
             "Distant checks converge to their mean grey.")};
}

Lesson make(const DemoSize& size, const Settings&) {
  Figure figure{.title = "Moiré: detail too fine for the pixels appears as a false pattern", .rows = {{}, {}}};
  for (const auto& columns : {rings(size.panel), checks(size.panel)})
    for (const Column& c : columns) figure.rows[0].push_back(c.above), figure.rows[1].push_back(c.below);
  figure.text =
      "Pixels cannot represent waves shorter than two pixels. A wave of f > ½ cycles per pixel does not vanish: it "
      "appears at the frequency |f − round(f)|, its alias. Filtering must come before sampling; afterwards an alias "
      "cannot be distinguished from a real wave. (Errors against 256 samples per pixel, root mean square of linear "
      "light.)";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace moire_lesson

Demo demo_moire() {
  return {"moire", "rings and checks finer than the pixels, sampled and filtered", moire_lesson::make};
}

}  // namespace zoneplate::lessons
