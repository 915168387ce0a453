// SPDX-License-Identifier: Apache-2.0
// zoneplate sdf field: the distances of a scene of shapes.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/sdf/scene_args.h"
#include "zoneplate/cli/sdf/sdf.h"
#include "zoneplate/cli/sdf/show_field.h"
#include "zoneplate/cli/signal/show.h"

namespace zoneplate::cli {
namespace {

struct FieldArgs : ShapeSceneArgs {
  FieldViewArgs view;
};

Syntax make_syntax(FieldArgs& args) {
  Syntax syntax{.verb = "sdf field",
                .summary = "Show or store the distances of a scene of shapes",
                .operands = "SCENE -o FILE",
                .examples =
                    "  zoneplate sdf field badge.sdf -o field.png\n"
                    "  zoneplate sdf field badge.sdf --show isolines --spacing 20 -o isolines.png\n"
                    "  zoneplate sdf field badge.sdf -o field.exr         the distances themselves, in pixels\n",
                .notes =
                    "The field is that of the union of all layers: negative inside. Distances are exact for single\n"
                    "shapes, outside of unions and inside intersections; elsewhere they are lower bounds.\n\n" +
                    shape_scene_notes()};
  syntax.options = field_view_options(args.view, "units of the scene");
  for (Option& option : shape_scene_options(args)) syntax.options.push_back(std::move(option));
  for (Option& option :
       signal_options(args, "The image to write: a .png file, or - for stdout; .pfm and .exr hold distances in pixels"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_sdf_field(std::span<const std::string> arguments) {
  FieldArgs args;
  args.report = "zoneplate-sdf";
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one SCENE");
  check_result_name(args.output);
  run_subcommand(args, {input, args.font}, {}, [&](Delivery& out) {
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
                 fmt::format("{}, {} × {} pixels, distances from {:.3f} to {:.3f} units\n", title_of(input),
                             raster.width, raster.height, low, high),
                 {{"input", input},
                  {"output", args.output},
                  {"width", raster.width},
                  {"height", raster.height},
                  {"least", low},
                  {"greatest", high}},
                 out);
  });
}

}  // namespace zoneplate::cli
