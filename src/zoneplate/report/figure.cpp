// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/figure.h"

#include <map>
#include <utility>

#include "zoneplate/report/figure_layout.h"

namespace zoneplate {
namespace {

/// Draws an outline of one pixel around the image, so that the edges of light images are visible.
void draw_outline(const FigureLayout::Image& placed, Rgba8 line, Rgba8Image& sheet) {
  const auto set = [&](int x, int y) {
    if (x >= 0 && y >= 0 && x < sheet.width() && y < sheet.height()) sheet(x, y) = line;
  };
  const int left = placed.left - 1, top = placed.top - 1;
  const int right = placed.left + placed.picture->width(), bottom = placed.top + placed.picture->height();
  for (int x = left; x <= right; ++x) set(x, top), set(x, bottom);
  for (int y = top; y <= bottom; ++y) set(left, y), set(right, y);
}

void draw_image(const FigureLayout::Image& placed, Rgba8Image& sheet) {
  const Rgba8Image& picture = *placed.picture;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const Rgba8 c = picture(x, y);
      Rgba8& pixel = sheet(placed.left + x, placed.top + y);
      pixel = c.a == 255 ? c : laid_over(pixel, c, 255);
    }
}

}  // namespace

Rgba8Image compose(const Figure& figure, const FigureStyle& style) {
  const FigureLayout layout = lay_out(figure, style);
  Rgba8Image sheet(layout.width, layout.height, {style.paper.r, style.paper.g, style.paper.b, 255});
  for (const FigureLayout::Image& image : layout.images) {
    if (image.has_outline) draw_outline(image, outline_color(style), sheet);
    draw_image(image, sheet);
  }
  std::map<std::pair<Typeface::Weight, int>, Typeface> faces;
  for (const FigureLayout::Line& line : layout.lines) {
    const auto face = faces.try_emplace({line.weight, line.px}, line.weight, line.px).first;
    face->second.draw(sheet, line.left, line.top, line.text, style.ink);
  }
  return sheet;
}

Rgba8Image enlarged(const Rgba8Image& picture, int factor) {
  Rgba8Image large(picture.width() * factor, picture.height() * factor);
  for (int y = 0; y < large.height(); ++y)
    for (int x = 0; x < large.width(); ++x) large(x, y) = picture(x / factor, y / factor);
  return large;
}

}  // namespace zoneplate
