// SPDX-License-Identifier: Apache-2.0
// zoneplate sdf field: the distances of a scene of shapes.
#include "zoneplate/cli/sdf/scene_args.h"
#include "zoneplate/cli/sdf/sdf.h"
#include "zoneplate/imaging/sdf/shape_field.h"

namespace zoneplate::cli {
namespace {

Syntax make_syntax(ShapeFieldOptions& args) {
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
  ShapeFieldOptions args;
  args.report = "zoneplate-sdf";
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one SCENE");
  check_result_name(args.output);
  run_subcommand(args, {input, args.font}, {}, [&](Delivery& out) { save_shape_field(input, args, out); });
}

}  // namespace zoneplate::cli
