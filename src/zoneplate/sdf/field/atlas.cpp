// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/field/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "zoneplate/base/error.h"

namespace zoneplate::sdf {
namespace {

/// The texels of a glyph: its bounds, half of the range around them, and half a texel to the outermost centres.
struct Cell {
  int width = 0, height = 0, x = 0, y = 0;
  Point move;  ///< of the baseline's start in the cell
};

Cell cell_of(const Outline& outline, const AtlasOptions& options) {
  const Bounds b = outline.bounds();
  if (b.empty()) return {};
  const double margin = options.range / 2 + 0.5;
  Cell cell;
  cell.width = static_cast<int>(std::ceil((b.high.x - b.low.x) * options.size + 2 * margin));
  cell.height = static_cast<int>(std::ceil((b.high.y - b.low.y) * options.size + 2 * margin));
  cell.move = {(cell.width - (b.low.x + b.high.x) * options.size) / 2,
               (cell.height - (b.low.y + b.high.y) * options.size) / 2};
  return cell;
}

/// Sets the places of the cells in rows of this width; returns the height.
int pack(std::vector<Cell>& cells, std::span<const std::size_t> order, int width) {
  int x = 0, top = 0, bottom = 0;
  for (const std::size_t i : order) {
    if (x + cells[i].width > width) x = 0, top = bottom;
    cells[i].x = x, cells[i].y = top;
    x += cells[i].width;
    bottom = std::max(bottom, top + cells[i].height);
  }
  return bottom;
}

}  // namespace

const Atlas::Glyph* Atlas::find(char32_t code) const {
  const auto found = std::ranges::find(glyphs, code, &Glyph::code);
  return found == glyphs.end() ? nullptr : &*found;
}

Atlas make_atlas(std::span<const GlyphOutline> glyphs, const AtlasOptions& options) {
  std::vector<Cell> cells;
  for (const GlyphOutline& glyph : glyphs) cells.push_back(cell_of(glyph.outline, options));
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cells[a].height > cells[b].height; });
  int width = 4, height = 0;
  for (const Cell& cell : cells) width = std::max(width, (cell.width + 3) / 4 * 4);
  while ((height = pack(cells, order, width)) > width) width += 4;
  if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(std::max(height, 1)) > options.max_texels)
    throw Error(ErrorKind::Usage, fmt::format("an atlas of {} × {} texels is too large, the limit is {} (--max-pixels)",
                                              width, height, options.max_texels));

  Atlas atlas{.field = {options.kind, Plane<float4>(width, std::max(height, 1), float4{-1e6f, -1e6f, -1e6f, -1e6f})},
              .size = options.size,
              .range = options.range};
  for (std::size_t i = 0; i < glyphs.size(); ++i) {
    const Cell& cell = cells[i];
    Atlas::Glyph glyph{glyphs[i].code, glyphs[i].advance, {}, {}};
    if (cell.width > 0) {
      const FieldImage field = outline_field(glyphs[i].outline, options.kind, cell.width, cell.height, options.size,
                                             cell.move, options.range);
      for (int y = 0; y < cell.height; ++y)
        std::ranges::copy(field.distances.row(y), atlas.field.distances.row(cell.y + y).begin() + cell.x);
      const Point low{0.5, 0.5}, high{cell.width - 0.5, cell.height - 0.5};
      const Point place{static_cast<double>(cell.x), static_cast<double>(cell.y)};
      glyph.plane = {(low - cell.move) * (1 / options.size), (high - cell.move) * (1 / options.size)};
      glyph.cell = {place + low, place + high};
    }
    atlas.glyphs.push_back(glyph);
  }
  atlas.field.distances = decoded(encoded(atlas), options.range);
  return atlas;
}

Plane<float4> encoded(const Atlas& atlas) {
  Plane<float4> out = atlas.field.distances;
  const auto code = [&](float d) {
    return static_cast<float>(std::floor(std::clamp(0.5 + static_cast<double>(d) / atlas.range, 0.0, 1.0) * 255 + 0.5) /
                              255);
  };
  for (float4& c : out.values()) c = {code(c.x), code(c.y), code(c.z), code(c.w)};
  return out;
}

Plane<float4> decoded(Plane<float4> values, double range) {
  const auto distance = [&](float v) { return static_cast<float>((static_cast<double>(v) - 0.5) * range); };
  for (float4& c : values.values()) c = {distance(c.x), distance(c.y), distance(c.z), distance(c.w)};
  return values;
}

void draw_text(const Atlas& atlas, std::span<const char32_t> text, Point origin, double em, Plane<float>& image) {
  double pen = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (i > 0) {
      const auto pair = atlas.kerning.find({text[i - 1], text[i]});
      if (pair != atlas.kerning.end()) pen += pair->second;
    }
    const Atlas::Glyph* const glyph = atlas.find(text[i]);
    if (glyph == nullptr) continue;
    if (!glyph->plane.empty() && !glyph->cell.empty()) {
      const double scale = em * (glyph->plane.high.x - glyph->plane.low.x) / (glyph->cell.high.x - glyph->cell.low.x);
      atlas.field.add_part(image, origin + (glyph->plane.low + Point{pen, 0}) * em, scale, glyph->cell);
    }
    pen += glyph->advance;
  }
}

}  // namespace zoneplate::sdf
