// SPDX-License-Identifier: Apache-2.0
// zoneplate texture levels: the pyramid of an image, with its memory.
#include "zoneplate/imaging/texture/levels.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/texture/texture.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

Syntax make_syntax(TextureLevels& args) {
  Syntax syntax{.verb = "texture levels",
                .summary = "Make the mip levels of an image, and print their sizes and memory",
                .operands = "IMAGE",
                .examples =
                    "  zoneplate texture levels photo.jpg -o levels.png\n"
                    "  zoneplate texture levels bricks --ripmap -o ripmap.png\n"
                    "  zoneplate texture levels leaf.png --alpha-cutoff 0.5\n",
                .notes =
                    "Level l + 1 is half as wide and high as level l. Mip levels take a third more memory than the\n"
                    "image; a ripmap, which is reduced along each axis separately, takes three times more. Bytes\n"
                    "are those of the texels as the renderer stores them.\n\n" +
                    image_notes()};
  const std::string group = "Options";
  syntax.options = {
      {"--mip-filter", "FILTER", "Filter between levels: box, kaiser or lanczos; default box", group, true,
       [&](auto& text) {
         constexpr MipFilter filters[] = {MipFilter::Box, MipFilter::Kaiser, MipFilter::Lanczos};
         args.options.filter = filters[parse_choice(text, {"box", "kaiser", "lanczos"})];
       }},
      {"--wrap", "MODE", "Texels beyond the border: repeat, mirror or clamp; default repeat", group, false,
       [&](auto& text) {
         constexpr Wrap modes[] = {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp};
         args.options.wrap_u = args.options.wrap_v = modes[parse_choice(text, {"repeat", "mirror", "clamp"})];
       }},
      {"--alpha-cutoff", "A", "Keep the fraction of texels whose alpha is at least A", group, false,
       [&](auto& text) { args.options.kept_cutoff = static_cast<float>(parse_number(text, 0.001, 1)); }},
      {"--straight-alpha", "", "Average colours without regard to alpha, as GPUs do; default: weighted by alpha", group,
       false, [&](auto&) { args.weights_by_alpha = false; }},
      {"--values", "", "The image holds data, not sRGB colours", group, false,
       [&](auto&) { args.meaning = TexelMeaning::Values; }},
      {"--ripmap", "", "Show the ripmap", group, true, [&](auto&) { args.shows_ripmap = true; }}};
  for (Option& option : image_options(args, "The image of all levels to write: a .png file, or - for stdout"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_texture_levels(std::span<const std::string> arguments) {
  TextureLevels args;
  args.report = "zoneplate-texture";
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  check_picture_name(args.output);
  run_subcommand(args, {input}, {}, [&](Delivery& out) { show_levels(input, args, out); });
}

}  // namespace zoneplate::cli
