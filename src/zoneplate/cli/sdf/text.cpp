// SPDX-License-Identifier: Apache-2.0
// zoneplate sdf text and sdf atlas: a font's glyphs as distance fields, and text from them.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/sdf/atlas_file.h"
#include "zoneplate/cli/sdf/sdf.h"
#include "zoneplate/cli/sdf/show_field.h"
#include "zoneplate/cli/sdf/text_error.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/job/values.h"
#include "zoneplate/os/file.h"
#include "zoneplate/report/table.h"

namespace zoneplate::cli {
namespace {

struct TextArgs : SignalArgs {
  std::string font, metrics, atlas;
  std::string characters;
  double px = 64;
  std::vector<int> sizes;
  bool is_exact = false;
  sdf::AtlasOptions options;
};

const std::string group = "Options";

std::vector<Option> font_options(TextArgs& args) {
  return {{"--font", "FILE", "TrueType or OpenType font; default DejaVu Sans", group, true,
           [&](auto& text) { args.font = text; }},
          {"--texels", "N", "Texels per em of the field, 4 to 512; default 32", group, true,
           [&](auto& text) { args.options.size = parse_number(text, 4, 512); }},
          {"--range", "N", "Texels between the lowest and highest distance that 8 bits hold; default 4", group, true,
           [&](auto& text) { args.options.range = parse_number(text, 1, 64); }}};
}

Syntax text_syntax(TextArgs& args) {
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

Syntax atlas_syntax(TextArgs& args) {
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

Font font_of(const TextArgs& args, Delivery& out) {
  const std::string path = args.font.empty() ? dejavu_path("DejaVuSans.ttf") : args.font;
  std::optional<Font> font;
  out.read(path, [&] { font.emplace(path); });
  return std::move(*font);
}

constexpr std::uint64_t most_atlas_pixels = std::uint64_t{1} << 26;

/// Black text on white, in linear light.
void save_image(const std::string& path, const Rgba8Image& image, Delivery& out) {
  if (!path.empty()) save_picture(path, image, out);
}

}  // namespace

void run_sdf_text(std::span<const std::string> arguments) {
  TextArgs args;
  args.report = "zoneplate-sdf";
  Syntax syntax = text_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& words = only_operand(syntax, "one TEXT");
  check_picture_name(args.output);
  if (args.atlas.empty() != args.metrics.empty())
    throw Error(ErrorKind::Usage, "--atlas and --metrics belong together");
  if (words.empty() || words.size() > 1000) throw Error(ErrorKind::Usage, "TEXT has 1 to 1000 bytes");
  run_subcommand(args, {args.atlas.empty() ? args.font : args.atlas, args.metrics, args.font}, {}, [&](Delivery& out) {
    const Font font = font_of(args, out);
    const bool is_loaded = !args.atlas.empty();
    const auto atlas_for = [&](sdf::FieldKind kind) {
      sdf::AtlasOptions options = args.options;
      options.kind = kind;
      if (!is_loaded) return atlas_of(font, code_points(words), options);
      std::optional<sdf::Atlas> atlas;
      out.read(args.atlas,
               [&] { atlas = load_atlas(args.atlas, args.metrics, std::min(out.limits().pixels, most_atlas_pixels)); });
      return std::move(*atlas);
    };
    if (!args.sizes.empty()) {
      Table table{.head = {"pixels per em"}, .rows = {}};
      std::vector<sdf::Atlas> atlases;
      if (is_loaded) {
        atlases.push_back(atlas_for(args.options.kind));
      } else {
        for (const sdf::FieldKind kind : {sdf::FieldKind::Single, sdf::FieldKind::Multi})
          atlases.push_back(atlas_for(kind));
      }
      for (const sdf::Atlas& atlas : atlases)
        for (const char* what : {"rms", "greatest"})
          table.head.push_back(fmt::format("{} {}", name_of(atlas.field.kind), what));
      for (const char* what : {"rms", "greatest"}) table.head.push_back(fmt::format("outline {}", what));
      Json::Array rows;
      for (const int px : args.sizes) {
        const TextLine line(font, words, px);
        const Plane<float> exact = line.exact();
        std::vector<std::string> row{std::to_string(px)};
        Json::Object entry{{"size", px}};
        const auto add = [&](const std::string& name, const Plane<float>& coverage) {
          const CoverageError e = error_of(coverage, exact);
          row.push_back(fmt::format("{:.4f}", e.rms)), row.push_back(fmt::format("{:.4f}", e.greatest));
          entry.emplace_back(name, Json::Object{{"rms", e.rms}, {"greatest", e.greatest}, {"pixels", e.pixels}});
        };
        for (const sdf::Atlas& atlas : atlases) add(name_of(atlas.field.kind), line.from_atlas(atlas));
        add("outline", line.from_outline());
        table.rows.push_back(std::move(row));
        rows.emplace_back(std::move(entry));
      }
      print_result(
          args, table_text(table),
          {{"text", words}, {"texels", atlases[0].size}, {"range", atlases[0].range}, {"sizes", std::move(rows)}}, out);
      return;
    }
    const TextLine line(font, words, args.px);
    const Plane<float> exact = line.exact();
    const Plane<float> drawn = args.is_exact ? exact : line.from_atlas(atlas_for(args.options.kind));
    save_image(args.output, black_on_white(drawn), out);
    const CoverageError error = error_of(drawn, exact);
    const std::string kind = args.is_exact ? "exact" : is_loaded ? "atlas" : name_of(args.options.kind);
    print_result(args,
                 fmt::format("{}, {} × {} pixels, error along edges {:.4f} root mean square, {:.4f} at most\n", kind,
                             drawn.width(), drawn.height(), error.rms, error.greatest),
                 {{"text", words},
                  {"type", kind},
                  {"output", args.output},
                  {"width", drawn.width()},
                  {"height", drawn.height()},
                  {"rms", error.rms},
                  {"greatest", error.greatest}},
                 out);
  });
}

void run_sdf_atlas(std::span<const std::string> arguments) {
  TextArgs args;
  args.report = "zoneplate-sdf";
  for (char c = ' '; c <= '~'; ++c) args.characters += c;
  Syntax syntax = atlas_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (!syntax.found_operands.empty()) throw Error(ErrorKind::Usage, "sdf atlas has no operands; give -o FILE");
  check_picture_name(args.output);
  if (args.characters.empty() || args.characters.size() > 20'000)
    throw Error(ErrorKind::Usage, "--characters has 1 to 20000 bytes");
  run_subcommand(args, {args.font}, {args.metrics}, [&](Delivery& out) {
    const Font font = font_of(args, out);
    const sdf::Atlas atlas = atlas_of(font, code_points(args.characters), args.options);
    if (atlas.glyphs.empty()) throw Error(ErrorKind::Input, "the font has none of the characters");
    if (!args.output.empty())
      out.save(args.output,
               encode_png(atlas_image(atlas),
                          {.has_alpha = args.options.kind == sdf::FieldKind::MultiAlpha, .is_srgb = false}));
    if (!args.metrics.empty()) {
      out.save(args.metrics, atlas_metrics(atlas, font.metrics()).indented() + "\n");
    }
    const int width = atlas.field.distances.width(), height = atlas.field.distances.height();
    print_result(
        args,
        fmt::format("{} of {} glyphs, {} × {} texels, {:g} per em, {} kerning pairs\n", name_of(args.options.kind),
                    atlas.glyphs.size(), width, height, atlas.size, atlas.kerning.size()),
        {{"type", name_of(args.options.kind)},
         {"output", args.output},
         {"metrics", args.metrics},
         {"glyphs", static_cast<std::int64_t>(atlas.glyphs.size())},
         {"width", width},
         {"height", height}},
        out);
  });
}

}  // namespace zoneplate::cli
