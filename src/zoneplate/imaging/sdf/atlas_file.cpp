// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/sdf/atlas_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"

namespace zoneplate {
namespace {

constexpr std::array<std::string_view, 3> kind_names = {"sdf", "msdf", "mtsdf"};

/// Bounds with the origin at the bottom left, as JSON members.
Json bounds_json(double left, double bottom, double right, double top) {
  return Json::Object{{"left", left}, {"bottom", bottom}, {"right", right}, {"top", top}};
}

struct Sides {
  double left, bottom, right, top;
};
Sides sides_of(const JsonView& object) {
  const auto number = [&](const char* key) { return static_cast<double>(object.number(key)); };
  return {number("left"), number("bottom"), number("right"), number("top")};
}

}  // namespace

std::vector<char32_t> code_points(std::string_view text) {
  std::vector<char32_t> out;
  while (!text.empty()) out.push_back(take_code_point(text));
  return out;
}

sdf::Atlas atlas_of(const Font& font, const std::vector<char32_t>& characters, const sdf::AtlasOptions& options) {
  const std::set<char32_t> codes(characters.begin(), characters.end());
  std::vector<sdf::GlyphOutline> glyphs;
  for (const char32_t code : codes)
    if (font.has(code)) glyphs.push_back({code, font.advance(code), font.outline(code)});
  sdf::Atlas atlas = sdf::make_atlas(glyphs, options);
  for (const sdf::GlyphOutline& left : glyphs)
    for (const sdf::GlyphOutline& right : glyphs)
      if (const double by = font.kerning(left.code, right.code); by != 0) atlas.kerning[{left.code, right.code}] = by;
  return atlas;
}

Rgba8Image atlas_image(const sdf::Atlas& atlas) {
  const Plane<float4> values = sdf::encoded(atlas);
  Rgba8Image out(values.width(), values.height());
  const bool has_alpha = atlas.field.kind == sdf::FieldKind::MultiAlpha;
  std::ranges::transform(values.values(), out.values().begin(), [&](const float4& c) {
    const auto code = [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5f); };
    return Rgba8{code(c.x), code(c.y), code(c.z), has_alpha ? code(c.w) : std::uint8_t{255}};
  });
  return out;
}

Json atlas_metrics(const sdf::Atlas& atlas, const Font::Metrics& font) {
  const double height = atlas.field.distances.height();
  Json::Array glyphs, kerning;
  for (const sdf::Atlas::Glyph& glyph : atlas.glyphs) {
    Json::Object entry{{"unicode", static_cast<std::int64_t>(glyph.code)}, {"advance", glyph.advance}};
    if (!glyph.plane.empty()) {
      const sdf::Bounds &p = glyph.plane, &c = glyph.cell;
      entry.emplace_back("planeBounds", bounds_json(p.low.x, -p.high.y, p.high.x, -p.low.y));
      entry.emplace_back("atlasBounds", bounds_json(c.low.x, height - c.high.y, c.high.x, height - c.low.y));
    }
    glyphs.emplace_back(std::move(entry));
  }
  for (const auto& [pair, advance] : atlas.kerning)
    kerning.emplace_back(Json::Object{{"unicode1", static_cast<std::int64_t>(pair.first)},
                                      {"unicode2", static_cast<std::int64_t>(pair.second)},
                                      {"advance", advance}});
  return Json::Object{{"atlas", Json::Object{{"type", name_of(atlas.field.kind)},
                                             {"distanceRange", atlas.range},
                                             {"distanceRangeMiddle", 0},
                                             {"size", atlas.size},
                                             {"width", atlas.field.distances.width()},
                                             {"height", atlas.field.distances.height()},
                                             {"yOrigin", "bottom"}}},
                      {"metrics", Json::Object{{"emSize", 1},
                                               {"lineHeight", font.line_height},
                                               {"ascender", font.ascender},
                                               {"descender", font.descender},
                                               {"underlineY", font.underline},
                                               {"underlineThickness", font.underline_thickness}}},
                      {"glyphs", std::move(glyphs)},
                      {"kerning", std::move(kerning)}};
}

sdf::Atlas load_atlas(const std::string& image_file, const std::string& metrics_file, std::uint64_t max_pixels) {
  const MappedFileWatch watch;
  const FileBytes image_bytes(image_file), metrics_bytes(metrics_file);
  const PngImage png = decode_png(image_bytes.bytes(), image_file, max_pixels);
  if (png.pixels.empty()) throw Error(ErrorKind::Input, image_file + ": an atlas has 8 bits per channel");
  ImportBudget budget(metrics_file, {.memory = std::uint64_t{1} << 28, .seconds = 60});
  const JsonValue root = parse_json(metrics_bytes.bytes(), budget);
  watch.check(image_file);
  const JsonView file(root, metrics_file + ":"), head = file.object("atlas");
  sdf::Atlas atlas;
  const std::string type = head.text("type");
  const auto found = std::ranges::find(kind_names, type);
  if (found == kind_names.end() && type != "psdf")
    head.fail("type is " + quoted(type) + ", expected sdf, psdf, msdf or mtsdf");
  atlas.field.kind = type == "psdf" ? sdf::FieldKind::Single : static_cast<sdf::FieldKind>(found - kind_names.begin());
  atlas.size = static_cast<double>(head.number("size"));
  atlas.range = static_cast<double>(head.number("distanceRange"));
  const double middle = static_cast<double>(head.number("distanceRangeMiddle", 0.0f));
  if (!(atlas.size > 0) || !(atlas.range > 0)) head.fail("size and distanceRange must be greater than 0");
  const int width = png.pixels.width(), height = png.pixels.height();
  if (head.whole("width") != static_cast<std::uint64_t>(width) ||
      head.whole("height") != static_cast<std::uint64_t>(height))
    head.fail(fmt::format("width and height differ from the image's, {} × {}", width, height));
  const std::string origin = head.text("yOrigin", "bottom");
  if (origin != "bottom" && origin != "top") head.fail("yOrigin is " + quoted(origin) + ", expected bottom or top");
  const bool is_up = origin == "bottom";

  Plane<float4> values(width, height);
  std::ranges::transform(png.pixels.values(), values.values().begin(), [](Rgba8 c) {
    const auto unit = [](std::uint8_t v) { return static_cast<float>(v) / 255; };
    return float4{unit(c.r), unit(c.g), unit(c.b), unit(c.a)};
  });
  atlas.field.distances = sdf::decoded(std::move(values), atlas.range);
  for (float4& c : atlas.field.distances.values()) {
    const auto m = static_cast<float>(middle);
    c = c + float4{m, m, m, m};
  }

  for (std::size_t i = 0; i < file.count("glyphs"); ++i) {
    const JsonView entry = file.element("glyphs", i, "glyph");
    sdf::Atlas::Glyph glyph;
    glyph.code = static_cast<char32_t>(entry.whole("unicode", std::nullopt, 0x10ffff));
    glyph.advance = static_cast<double>(entry.number("advance"));
    if (entry.has("planeBounds") && entry.has("atlasBounds")) {
      const Sides plane = sides_of(entry.object("planeBounds")), cell = sides_of(entry.object("atlasBounds"));
      const auto down = [&](double y) { return is_up ? height - y : y; };
      glyph.plane = is_up ? sdf::Bounds{{plane.left, -plane.top}, {plane.right, -plane.bottom}}
                          : sdf::Bounds{{plane.left, plane.top}, {plane.right, plane.bottom}};
      glyph.cell = {{cell.left, down(cell.top)}, {cell.right, down(cell.bottom)}};
      if (!(glyph.cell.low.x >= 0 && glyph.cell.low.y >= 0 && glyph.cell.high.x <= width &&
            glyph.cell.high.y <= height) ||
          !(glyph.cell.high.x > glyph.cell.low.x && glyph.cell.high.y > glyph.cell.low.y))
        entry.fail("atlasBounds are not a rectangle within the image");
      if (!(glyph.plane.high.x > glyph.plane.low.x && glyph.plane.high.y > glyph.plane.low.y))
        entry.fail("planeBounds are empty");
    }
    atlas.glyphs.push_back(glyph);
  }
  for (std::size_t i = 0; i < file.count("kerning"); ++i) {
    const JsonView entry = file.element("kerning", i, "kerning pair");
    const auto code = [&](const char* key) { return static_cast<char32_t>(entry.whole(key, std::nullopt, 0x10ffff)); };
    atlas.kerning[{code("unicode1"), code("unicode2")}] = static_cast<double>(entry.number("advance"));
  }
  return atlas;
}

const char* name_of(sdf::FieldKind kind) { return kind_names[static_cast<std::size_t>(kind)].data(); }
sdf::FieldKind parse_field_kind(const std::string& text) {
  return static_cast<sdf::FieldKind>(parse_choice(text, std::span<const std::string_view>(kind_names)));
}

}  // namespace zoneplate
