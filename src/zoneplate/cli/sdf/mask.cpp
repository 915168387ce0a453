// SPDX-License-Identifier: Apache-2.0
// zoneplate sdf from-mask and to-mask: the field of an image's bright pixels, and the image of a stored field.
#include "zoneplate/imaging/sdf/mask.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/sdf/scene_args.h"
#include "zoneplate/cli/sdf/sdf.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

Syntax from_mask_syntax(MaskOptions& args) {
  Syntax syntax{.verb = "sdf from-mask",
                .summary = "Make the distance field of an image's bright pixels",
                .operands = "IMAGE -o FILE",
                .examples =
                    "  zoneplate sdf from-mask logo.png --alpha -o field.exr\n"
                    "  zoneplate sdf from-mask scan.png --invert --show isolines -o isolines.png\n",
                .notes =
                    "A pixel is inside if its stored value, the luma or alpha, is greater than the threshold. The\n"
                    "distance is exact: that of the nearest centre of a pixel of the other kind, minus half a pixel;\n"
                    "negative inside. `zoneplate sdf to-mask` draws it again, at any size.\n\n" +
                    image_notes()};
  const std::string group = "Options";
  syntax.options = {{"--threshold", "T", "Values above are inside, 0 to 1; default 0.5", group, true,
                     [&](auto& text) { args.threshold = parse_number(text, 0, 1); }},
                    {"--alpha", "", "Take alpha instead of luma", group, true, [&](auto&) { args.uses_alpha = true; }},
                    {"--invert", "", "Dark pixels are inside", group, true, [&](auto&) { args.is_inverted = true; }}};
  for (Option& option : field_view_options(args.view, "pixels")) syntax.options.push_back(std::move(option));
  for (Option& option : image_options(args, "The field to write: .exr or .pfm in pixels, .png or - to look at"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

Syntax to_mask_syntax(MaskOptions& args) {
  Syntax syntax{.verb = "sdf to-mask",
                .summary = "Draw a stored distance field, antialiased",
                .operands = "FIELD -o FILE",
                .examples =
                    "  zoneplate sdf to-mask field.exr -o mask.png\n"
                    "  zoneplate sdf to-mask field.exr --scale 4 -o large.png\n",
                .notes =
                    "FIELD is an .exr or .pfm file whose red channel has distances in pixels, negative inside, as\n"
                    "`zoneplate sdf field` and `from-mask` write it. Distances between the pixels' centres are\n"
                    "interpolated bilinearly. White is inside.\n"};
  syntax.options = {{"--scale", "S", "Pixels of the image per pixel of the field; default 1", "Options", true,
                     [&](auto& text) { args.scale = parse_number(text, 1e-2, 1e3); }}};
  for (Option& option : image_options(args, result_meaning)) syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_sdf_from_mask(std::span<const std::string> arguments) {
  MaskOptions args;
  args.report = "zoneplate-sdf";
  Syntax syntax = from_mask_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  check_result_name(args.output);
  run_subcommand(args, {input}, {}, [&](Delivery& out) { make_field_of_mask(input, args, out); });
}

void run_sdf_to_mask(std::span<const std::string> arguments) {
  MaskOptions args;
  args.report = "zoneplate-sdf";
  Syntax syntax = to_mask_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one FIELD");
  check_result_name(args.output);
  if (!input.ends_with(".pfm") && !input.ends_with(".exr"))
    throw Error(ErrorKind::Usage, input + ": expected a field of distances, a .pfm or .exr file");
  run_subcommand(args, {input}, {}, [&](Delivery& out) { draw_mask_of_field(input, args, out); });
}

}  // namespace zoneplate::cli
