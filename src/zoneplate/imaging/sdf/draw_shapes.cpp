// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/sdf/draw_shapes.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "zoneplate/imaging/signal/show.h"

namespace zoneplate {
namespace {

constexpr int reference_grid = 16;

struct ImageError {
  double greatest = 0, rms = 0;  ///< of linear channels; rms over the pixels that differ
  int pixels = 0;
};

ImageError error_of(const LinearImage& image, const LinearImage& reference) {
  ImageError error;
  double squares = 0;
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    const Linear a = image.values()[i], b = reference.values()[i];
    double greatest = 0;
    for (const float d : {a.r - b.r, a.g - b.g, a.b - b.b, a.a - b.a})
      greatest = std::max(greatest, std::abs(static_cast<double>(d)));
    if (greatest < 1e-6) continue;
    error.greatest = std::max(error.greatest, greatest);
    squares += greatest * greatest;
    ++error.pixels;
  }
  error.rms = error.pixels == 0 ? 0 : std::sqrt(squares / error.pixels);
  return error;
}

}  // namespace

void draw_shapes(const std::string& input, const DrawShapesOptions& args, Delivery& out) {
  const sdf::SceneFile scene = load_shape_scene(input, {.text_outline = text_outlines(args)}, out);
  const sdf::Raster raster = raster_of(scene, args, input);
  const auto start = std::chrono::steady_clock::now();
  const LinearImage image = sdf::draw(scene.drawing, raster, scene.background, args.grid);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  if (!args.output.empty())
    save_result(
        args.output, image, [&] { return shown(image, false); }, out);

  const std::size_t layers = scene.drawing.layers.size();
  std::string text = fmt::format("{}, {} × {} pixels, {} layer{}, {:.1f} ms\n", title_of(input), raster.width,
                                 raster.height, layers, layers == 1 ? "" : "s", time.count());
  Json::Object json{{"input", input},
                    {"output", args.output},
                    {"width", raster.width},
                    {"height", raster.height},
                    {"layers", static_cast<std::int64_t>(layers)},
                    {"milliseconds", time.count()}};
  if (args.measures_error) {
    const ImageError error = error_of(image, sdf::draw(scene.drawing, raster, scene.background, reference_grid));
    text += fmt::format(
        "difference from {0} × {0} squares per pixel: at most {1:.4f}, root mean square {2:.4f} over "
        "{3} pixels (linear, white is 1)\n",
        reference_grid, error.greatest, error.rms, error.pixels);
    json.emplace_back("error",
                      Json::Object{{"greatest", error.greatest}, {"rms", error.rms}, {"pixels", error.pixels}});
  }
  print_result(args, text, json, out);
}

}  // namespace zoneplate
