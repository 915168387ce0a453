// SPDX-License-Identifier: Apache-2.0
// zoneplate texture normal-from-height: a normal map from a height map.
#include "zoneplate/imaging/texture/normal_from_height.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/texture/texture.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

Syntax make_syntax(NormalMapOptions& args) {
  Syntax syntax{
      .verb = "texture normal-from-height",
      .summary = "Make a normal map from a height map",
      .operands = "IMAGE -o FILE",
      .examples =
          "  zoneplate texture normal-from-height height.png -o normal.png\n"
          "  zoneplate texture normal-from-height height.png --gradient central --strength 8 -o normal.png\n"
          "  zoneplate texture normal-from-height rings --wrap clamp -o normal.exr\n",
      .notes =
          "Heights are the luma of the stored values, 0 to 1. The normal of a texel is (-dh/dx, dh/dy, 1),\n"
          "normalised, with x to the right and y upwards, as glTF 2.0 requires; red, green and blue are half of\n"
          "it plus a half.\n\n" +
          image_notes()};
  const std::string group = "Options";
  syntax.options = {
      {"--gradient", "KIND", "Gradient: sobel or central; default sobel", group, true,
       [&](auto& text) {
         args.heights.stencil =
             parse_choice(text, {"sobel", "central"}) == 0 ? GradientStencil::Sobel : GradientStencil::Central;
       }},
      {"--strength", "TEXELS", "Height of white above black, in texels; negative: black is high; default 4", group,
       true, [&](auto& text) { args.heights.strength = static_cast<float>(parse_number(text, -1e6, 1e6)); }},
      {"--wrap", "MODE", "Heights beyond the border: repeat, mirror or clamp; default repeat", group, true,
       [&](auto& text) {
         constexpr Wrap modes[] = {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp};
         args.heights.wrap_u = args.heights.wrap_v = modes[parse_choice(text, {"repeat", "mirror", "clamp"})];
       }}};
  for (Option& option : image_options(args, result_meaning)) syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_texture_normal_from_height(std::span<const std::string> arguments) {
  NormalMapOptions args;
  args.report = "zoneplate-texture";
  args.heights.strength = 4;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  check_result_name(args.output);
  run_subcommand(args, {input}, {}, [&](Delivery& out) { make_normal_map(input, args, out); });
}

}  // namespace zoneplate::cli
