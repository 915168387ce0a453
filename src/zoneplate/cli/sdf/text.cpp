// SPDX-License-Identifier: Apache-2.0
// zoneplate sdf text and sdf atlas: a font's glyphs as distance fields, and text from them.
#include "zoneplate/imaging/sdf/text.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/sdf/sdf.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/imaging/sdf/atlas_file.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

const std::string group = "Options";

std::vector<Option> font_options(TextOptions& args) {
  return {{"--font", "FILE", "TrueType or OpenType font; default DejaVu Sans", group, true,
           [&](auto& text) { args.font = text; }},
          {"--texels", "N", "Texels per em of the field, 4 to 512; default 32", group, true,
           [&](auto& text) { args.options.size = parse_number(text, 4, 512); }},
          {"--range", "N", "Texels between the lowest and highest distance that 8 bits hold; default 4", group, true,
           [&](auto& text) { args.options.range = parse_number(text, 1, 64); }}};
}

Syntax text_syntax(TextOptions& args) {
  Syntax syntax{
      .verb = "sdf text",
      .summary = "Draw text from distance fields, and measure it against the exact coverage of its outlines",
      .operands = "TEXT -o FILE",
      .examples =
          "  zoneplate sdf text \"Zone plate\" -o text.png\n"
          "  zoneplate sdf text \"Zone plate\" --type sdf --size 128 -o single.png\n"
          "  zoneplate sdf text \"Zone plate\" --sizes 16,32,64,128,256\n"
          "  zoneplate sdf text \"Play\" --atlas game.png --metrics game.json --font game.ttf -o play.png\n",
      .notes =
          "`sdf` stores one distance per texel, which rounds corners; `msdf` stores three whose median keeps\n"
          "them; `mtsdf` adds the single distance in alpha; `exact` draws the area of the outlines in each\n"
          "pixel. Errors are differences of coverage from `exact`: root mean square over the pixels along\n"
          "edges, and the greatest. `outline` in the table is drawn from the outlines' own distances.\n"};
  syntax.options = {{"--type", "TYPE", "sdf, msdf, mtsdf or exact; default msdf", group, true,
                     [&](auto& text) {
                       args.is_exact = text == "exact";
                       if (!args.is_exact) args.options.kind = parse_field_kind(text);
                     }},
                    {"--size", "PX", "Pixels per em, 4 to 2048; default 64", group, true,
                     [&](auto& text) { args.px = parse_number(text, 4, 2048); }},
                    {"--sizes", "LIST", "Print the errors at these sizes instead of one", group, true,
                     [&](auto& text) { args.sizes = parse_whole_list(text, 4, 2048); }},
                    {"--atlas", "FILE", "Draw from this atlas, a .png file; requires --metrics", group, false,
                     [&](auto& text) { args.atlas = text; }},
                    {"--metrics", "FILE", "Its metrics, the JSON of msdf-atlas-gen or `sdf atlas`", group, false,
                     [&](auto& text) { args.metrics = text; }}};
  for (Option& option : font_options(args)) syntax.options.push_back(std::move(option));
  for (Option& option : signal_options(args, "The image to write: a .png file, or - for stdout"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

Syntax atlas_syntax(TextOptions& args) {
  Syntax syntax{.verb = "sdf atlas",
                .summary = "Make an atlas of a font's glyphs as distance fields",
                .operands = "-o FILE",
                .examples =
                    "  zoneplate sdf atlas -o atlas.png --metrics atlas.json\n"
                    "  zoneplate sdf atlas --font game.ttf --characters \"0123456789:\" --type mtsdf -o digits.png\n",
                .notes =
                    "The metrics have the form that msdf-atlas-gen writes: for each glyph its advance and quad in em\n"
                    "(`planeBounds`) and in texels (`atlasBounds`), from the bottom. The value 0.5 is the outline;\n"
                    "0 and 1 are half of the range outside and inside. The image is data, not sRGB colour.\n"};
  syntax.options = {
      {"--type", "TYPE", "sdf, msdf or mtsdf; default msdf", group, true,
       [&](auto& text) { args.options.kind = parse_field_kind(text); }},
      {"--characters", "TEXT", "Characters; default printable ASCII", group, true,
       [&](auto& text) { args.characters = text; }},
      {"--metrics", "FILE", "The JSON file to write", group, true, [&](auto& text) { args.metrics = text; }}};
  for (Option& option : font_options(args)) syntax.options.push_back(std::move(option));
  for (Option& option : signal_options(args, "The image to write: a .png file, or - for stdout"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_sdf_text(std::span<const std::string> arguments) {
  TextOptions args;
  args.report = "zoneplate-sdf";
  Syntax syntax = text_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& words = only_operand(syntax, "one TEXT");
  check_picture_name(args.output);
  if (args.atlas.empty() != args.metrics.empty())
    throw Error(ErrorKind::Usage, "--atlas and --metrics belong together");
  if (words.empty() || words.size() > 1000) throw Error(ErrorKind::Usage, "TEXT has 1 to 1000 bytes");
  run_subcommand(args, {args.atlas.empty() ? args.font : args.atlas, args.metrics, args.font}, {},
                 [&](Delivery& out) { draw_text(words, args, out); });
}

void run_sdf_atlas(std::span<const std::string> arguments) {
  TextOptions args;
  args.report = "zoneplate-sdf";
  for (char c = ' '; c <= '~'; ++c) args.characters += c;
  Syntax syntax = atlas_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (!syntax.found_operands.empty()) throw Error(ErrorKind::Usage, "sdf atlas has no operands; give -o FILE");
  check_picture_name(args.output);
  if (args.characters.empty() || args.characters.size() > 20'000)
    throw Error(ErrorKind::Usage, "--characters has 1 to 20000 bytes");
  run_subcommand(args, {args.font}, {args.metrics}, [&](Delivery& out) { make_atlas(args, out); });
}

}  // namespace zoneplate::cli
