// SPDX-License-Identifier: Apache-2.0
// Texture filters where a texture is reduced, on a board to the horizon.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/signal/border.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate::lessons {
namespace texture_filters_lesson {
namespace {

constexpr int factor = 4;                   // enlargement of the crops
constexpr float eighth_turn = 0.78539816f;  // the footprints' long axes lie between the axes of the texture

/// The board, turned by 45°, with another texture.
Scene board(const Rgba8Image* texture) {
  Scene scene = scene_of("checkerboard");
  scene.instances.at(0).world_from_object = rotation({0, 1, 0}, eighth_turn);
  if (texture != nullptr) scene.images.at(0).pixels = *texture;
  return scene;
}

struct Row {
  const char* filter;
  const char* meaning;
};
constexpr std::array<Row, 7> reduced = {
    {{"nearest", "One texel: false patterns far away, jagged edges near by."},
     {"bilinear", "Four texels of the full image: far away each pixel still misses nearly all texels under it."},
     {"trilinear", "Mip levels by the longer side of the footprint: no aliasing, but blur towards the horizon."},
     {"ripmap", "Levels reduced along u and v separately: helps along the axes only, and this board lies across them."},
     {"sat", "The mean over the bounding box of the footprint: the same limit."},
     {"probes:anisotropy=16", "Up to 11 trilinear probes along the footprint, as GPUs do."},
     {"ewa:anisotropy=16", "The Gaussian mean over the footprint's ellipse."}}};

struct Measured {
  Rgba8Image picture;
  double error;  // root mean square in linear light, below the horizon
};

std::array<Measured, 8> shoot_all(const Scene& scene, int side) {
  const auto of = [&](const std::string& method, const std::string& filter) {
    return shoot(scene, method,
                 RenderOptions{.width = side, .height = side, .texture_filter = parse_texture_filter(filter)});
  };
  const LinearImage reference = of("ssaa:samples=1024", "bilinear");
  const int first = side * 2 / 5;
  const auto below = [&](const LinearImage& image) {
    return cropped(luminance_of(image), 0, first, side, side - first);
  };
  std::array<Measured, 8> all;
  for (std::size_t i = 0; i < reduced.size(); ++i) {
    const LinearImage image = of("none", reduced[i].filter);
    all[i] = {shown(image), rms_difference(below(image), below(reference))};
  }
  all[7] = {shown(reference), 0};
  return all;
}

/// Two rows of images, each with a row of crops below.
std::vector<std::vector<Panel>> rows_of(const std::array<Measured, 8>& all, int side, int crop_y) {
  std::vector<std::vector<Panel>> rows;
  for (std::size_t half = 0; half < 2; ++half) {
    std::vector<Panel> pictures, crops;
    for (std::size_t i = 4 * half; i < 4 * half + 4; ++i) {
      const std::string caption = i == 7 ? "1024 samples per pixel\nThe reference."
                                         : fmt::format("{}\n{} Error {}\u00a0%.", reduced[i].filter, reduced[i].meaning,
                                                       number(100 * all[i].error, 1));
      const int x = side / 2, y = crop_y;
      pictures.push_back({marked(all[i].picture, x, y, factor, side), caption});
      crops.push_back({crop_of(all[i].picture, x, y, factor, side), ""});
    }
    rows.push_back(std::move(pictures)), rows.push_back(std::move(crops));
  }
  return rows;
}

constexpr std::string_view boards[] = {"checkerboard", "bricks"};
constexpr Param params[] = {{.name = "board", .meaning = "the texture", .value = 0, .names = boards}};

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel;
  const bool has_bricks = settings.chosen("board") == "bricks";
  const Rgba8Image wall = has_bricks ? shown(make_pattern("bricks")) : Rgba8Image();
  const std::array<Measured, 8> all = shoot_all(board(has_bricks ? &wall : nullptr), side);
  Figure figure{.title = "Texture filters: what a pixel takes of the texture under it",
                .rows = rows_of(all, side, side * (has_bricks ? 56 : 45) / 100)};
  Table table{{"filter", "error"}, {}};
  for (std::size_t i = 0; i < reduced.size(); ++i)
    table.rows.push_back({reduced[i].filter, number(100 * all[i].error, 2) + " %"});
  figure.text = fmt::format(
      "A board of {0} × {0} pixels, turned by 45°, one sample per pixel; the frames mark the regions that are enlarged "
      "{1} times. Errors: root mean square of the difference from 1024 samples per pixel in linear light, in percent "
      "of "
      "white, below the horizon. The lesson has two boards, board=checkerboard and board=bricks.",
      side, factor);
  return {.frames = {figure}, .tables = {table}};
}

}  // namespace
}  // namespace texture_filters_lesson

Demo demo_texture_filters() {
  return {"texture-filters", "every texture filter on a board to the horizon, with its error",
          texture_filters_lesson::make, texture_filters_lesson::params};
}

}  // namespace zoneplate::lessons
