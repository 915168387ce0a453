// SPDX-License-Identifier: Apache-2.0
// zoneplate texture normal-from-height: a normal map from a height map.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/base/parallel.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/load.h"
#include "zoneplate/cli/signal/show.h"
#include "zoneplate/cli/texture/texture.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/job/values.h"
#include "zoneplate/os/file.h"
#include "zoneplate/shade/texture/height_normals.h"

namespace zoneplate::cli {
namespace {

struct NormalArgs : SignalArgs {
  HeightNormals options;
};

Syntax make_syntax(NormalArgs& args) {
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
         args.options.stencil =
             parse_choice(text, {"sobel", "central"}) == 0 ? GradientStencil::Sobel : GradientStencil::Central;
       }},
      {"--strength", "TEXELS", "Height of white above black, in texels; negative: black is high; default 4", group,
       true, [&](auto& text) { args.options.strength = static_cast<float>(parse_number(text, -1e6, 1e6)); }},
      {"--wrap", "MODE", "Heights beyond the border: repeat, mirror or clamp; default repeat", group, true,
       [&](auto& text) {
         constexpr Wrap modes[] = {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp};
         args.options.wrap_u = args.options.wrap_v = modes[parse_choice(text, {"repeat", "mirror", "clamp"})];
       }}};
  for (Option& option : image_options(args, result_meaning)) syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_texture_normal_from_height(std::span<const std::string> arguments) {
  NormalArgs args;
  args.report = "zoneplate-texture";
  args.options.strength = 4;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  check_result_name(args.output);
  run_subcommand(args, {input}, {}, [&](Delivery& out) {
    const Plane<float3> normals = normals_of(luminance(load_texture(input, args.layer, out)), args.options);
    LinearImage encoded(normals.width(), normals.height());
    float steepest = 1;
    for (std::size_t i = 0; i < normals.values().size(); ++i) {
      const float3 n = normals.values()[i];
      encoded.values()[i] = {0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z, 1};
      steepest = std::min(steepest, n.z);
    }
    if (args.output.ends_with(".pfm") || args.output.ends_with(".exr")) {
      save_result(
          args.output, encoded, [] { return Rgba8Image(); }, out);
    } else if (!args.output.empty()) {
      out.save(args.output, encode_png(shown(encoded, true), {.has_alpha = false, .is_srgb = false}));
    }
    print_result(args,
                 fmt::format("{}, {} × {}: least z of a normal {:.3f}\n", printable(input), normals.width(),
                             normals.height(), steepest),
                 {{"input", input},
                  {"output", args.output},
                  {"width", normals.width()},
                  {"height", normals.height()},
                  {"least_z", steepest}},
                 out);
  });
}

}  // namespace zoneplate::cli
