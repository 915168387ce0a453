// SPDX-License-Identifier: Apache-2.0
// zoneplate sdf draw: a scene of shapes as an image.
#include "zoneplate/cli/sdf/scene_args.h"
#include "zoneplate/cli/sdf/sdf.h"
#include "zoneplate/imaging/sdf/draw_shapes.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

Syntax make_syntax(DrawShapesOptions& args) {
  Syntax syntax{.verb = "sdf draw",
                .summary = "Draw a scene of shapes, antialiased from their distances",
                .operands = "SCENE -o FILE",
                .examples =
                    "  zoneplate sdf draw badge.sdf -o badge.png\n"
                    "  zoneplate sdf draw badge.sdf --size 1920x1080 -o large.png\n"
                    "  zoneplate sdf draw badge.json --grid 4 --error -o fine.png\n",
                .notes =
                    "The coverage of a pixel is the area of the half-plane that has the distance and the gradient at\n"
                    "its centre: exact at straight edges, within 0.12 / r at an arc of radius r pixels. Corners and\n"
                    "parts thinner than a pixel need --grid.\n\n" +
                    shape_scene_notes()};
  syntax.options = {{"--grid", "N", "Divide each pixel into N × N squares, 1 to 16; default 1", "Options", true,
                     [&](auto& text) { args.grid = parse_whole(text, 1, 16); }},
                    {"--error", "", "Print the difference from a drawing with --grid 16", "Options", true,
                     [&](auto&) { args.measures_error = true; }}};
  for (Option& option : shape_scene_options(args)) syntax.options.push_back(std::move(option));
  for (Option& option : signal_options(args, result_meaning)) syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_sdf_draw(std::span<const std::string> arguments) {
  DrawShapesOptions args;
  args.report = "zoneplate-sdf";
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one SCENE");
  check_result_name(args.output);
  run_subcommand(args, {input, args.font}, {}, [&](Delivery& out) { draw_shapes(input, args, out); });
}

}  // namespace zoneplate::cli
