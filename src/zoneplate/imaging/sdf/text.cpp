// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/sdf/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/imaging/sdf/atlas_file.h"
#include "zoneplate/imaging/sdf/show_field.h"
#include "zoneplate/imaging/sdf/text_error.h"
#include "zoneplate/os/file.h"
#include "zoneplate/report/table.h"

namespace zoneplate {
namespace {

Font font_of(const TextOptions& args, Delivery& out) {
  const std::string path = args.font.empty() ? dejavu_path("DejaVuSans.ttf") : args.font;
  std::optional<Font> font;
  out.read(path, [&] { font.emplace(path); });
  return std::move(*font);
}

/// The limit of an atlas that is read or made.
std::uint64_t max_texels(const Delivery& out) { return std::min(out.limits().pixels, std::uint64_t{1} << 26); }

/// Black text on white, in linear light.
void save_image(const std::string& path, const Rgba8Image& image, Delivery& out) {
  if (!path.empty()) save_picture(path, image, out);
}

}  // namespace

void draw_text(const std::string& words, const TextOptions& args, Delivery& out) {
  const Font font = font_of(args, out);
  const bool is_loaded = !args.atlas.empty();
  const auto atlas_for = [&](sdf::FieldKind kind) {
    sdf::AtlasOptions options = args.options;
    options.kind = kind, options.max_texels = max_texels(out);
    if (!is_loaded) return atlas_of(font, code_points(words), options);
    std::optional<sdf::Atlas> atlas;
    out.read(args.atlas, [&] { atlas = load_atlas(args.atlas, args.metrics, max_texels(out)); });
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
}

void make_atlas(const TextOptions& args, Delivery& out) {
  const Font font = font_of(args, out);
  sdf::AtlasOptions options = args.options;
  options.max_texels = max_texels(out);
  const sdf::Atlas atlas = atlas_of(font, code_points(args.characters), options);
  if (atlas.glyphs.empty()) throw Error(ErrorKind::Input, "the font has none of the characters");
  if (!args.output.empty())
    out.save(args.output, encode_png(atlas_image(atlas),
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
}

}  // namespace zoneplate
