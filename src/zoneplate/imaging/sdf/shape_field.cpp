// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/sdf/shape_field.h"

#include <fmt/format.h>
#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/imaging/signal/show.h"

namespace zoneplate {

void save_shape_field(const std::string& input, const ShapeFieldOptions& args, Delivery& out) {
  const sdf::SceneFile scene =
      load_shape_scene(input, {.keeps_shapes = true, .text_outline = text_outlines(args)}, out);
  const sdf::Raster raster = raster_of(scene, args, input);
  if (scene.shapes.empty()) throw Error(ErrorKind::Input, input + ": no layer, so there is no distance");
  const sdf::DistanceField field = distance_field(sdf::combined(sdf::Shape::Kind::Union, scene.shapes), raster);
  if (!args.output.empty()) {
    LinearImage distances(raster.width, raster.height);
    std::ranges::transform(field.distance.values(), distances.values().begin(), [&](float d) {
      const float pixels = d * static_cast<float>(raster.scale);
      return Linear{pixels, pixels, pixels, 1};
    });
    save_result(
        args.output, distances, [&] { return show_field(field, args.view.view, args.view.spacing, raster.scale); },
        out);
  }
  const auto [low, high] = std::ranges::minmax(field.distance.values());
  print_result(args,
               fmt::format("{}, {} × {} pixels, distances from {:.3f} to {:.3f} units\n", title_of(input), raster.width,
                           raster.height, low, high),
               {{"input", input},
                {"output", args.output},
                {"width", raster.width},
                {"height", raster.height},
                {"least", low},
                {"greatest", high}},
               out);
}

}  // namespace zoneplate
