// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/figure_layout.h"

#include <algorithm>

namespace zoneplate {
namespace {

constexpr int min_width_em = 20;     // minimum width of a figure, so that a title fits over a small image
constexpr int hairline_share = 110;  // of 255: darkness of an image's outline
constexpr double title_scale = 1.5;  // documented in figure.h

/// A typeface, and how it was made.
struct Face {
  Face(Typeface::Weight of, int height) : typeface(of, height), weight(of), px(height) {}
  Typeface typeface;
  Typeface::Weight weight;
  int px;
};

struct Faces {
  explicit Faces(const FigureStyle& style)
      : text(Typeface::Weight::Regular, style.text_px),
        heading(Typeface::Weight::Bold, style.text_px),
        title(Typeface::Weight::Bold, static_cast<int>(title_scale * style.text_px + 0.5)) {}
  Face text, heading, title;
};

/// A text broken into lines.
struct Block {
  const Face* face = nullptr;
  std::vector<std::string> lines;

  int height() const { return static_cast<int>(lines.size()) * face->typeface.leading(); }
};

/// A panel whose caption is broken into lines; if the caption itself has several lines, the first is a heading.
struct Placed {
  const Panel* panel = nullptr;
  Block heading, text;

  int width() const { return panel->picture.width(); }
};

Block block(const Face& face, std::string_view text, int width) { return {&face, face.typeface.wrapped(text, width)}; }

Placed placed(const Faces& faces, const Panel& panel) {
  const std::string_view caption = panel.caption;
  const std::size_t end = caption.find('\n');
  const bool has_heading = end != std::string_view::npos;
  const int width = panel.picture.width();
  return {&panel, block(faces.heading, has_heading ? caption.substr(0, end) : std::string_view{}, width),
          block(faces.text, has_heading ? caption.substr(end + 1) : caption, width)};
}

/// True for an image whose border has the background colour, such as a plot.
bool fades_into_paper(const Rgba8Image& picture, Rgba8 paper) {
  const auto is_paper = [paper](Rgba8 c) { return c.a == 0 || c == Rgba8{paper.r, paper.g, paper.b, 255}; };
  const int w = picture.width(), h = picture.height();
  for (int x = 0; x < w; ++x)
    if (!is_paper(picture(x, 0)) || !is_paper(picture(x, h - 1))) return false;
  for (int y = 0; y < h; ++y)
    if (!is_paper(picture(0, y)) || !is_paper(picture(w - 1, y))) return false;
  return true;
}

using Row = std::vector<Placed>;

int width_of(const Row& row, int gap) {
  int width = 0;
  for (const Placed& p : row) width += p.width() + gap;
  return row.empty() ? 0 : width - gap;
}

int height_of(const Row& row, int caption_gap) {
  int height = 0;
  for (const Placed& p : row) {
    const int caption = p.heading.height() + p.text.height();
    height = std::max(height, p.panel->picture.height() + (caption > 0 ? caption_gap + caption : 0));
  }
  return height;
}

/// Appends the lines of a block, and returns the position below them.
int lay(const Block& block, int left, int top, std::vector<FigureLayout::Line>& lines) {
  for (const std::string& line : block.lines) {
    const Face& face = *block.face;
    lines.push_back({face.weight, face.px, left, top, top + face.typeface.ascent(), line});
    top += face.typeface.leading();
  }
  return top;
}

}  // namespace

FigureLayout lay_out(const Figure& figure, const FigureStyle& style) {
  const Faces faces(style);
  const int gap = style.gap_px, caption_gap = gap / 2;
  std::vector<Row> rows;
  int inner = min_width_em * style.text_px;
  for (const std::vector<Panel>& panels : figure.rows) {
    Row& row = rows.emplace_back();
    for (const Panel& panel : panels) row.push_back(placed(faces, panel));
    inner = std::max(inner, width_of(row, gap));
  }
  const Block title = block(faces.title, figure.title, inner), text = block(faces.text, figure.text, inner);

  // Each element is followed by a gap; the first gap is the top margin.
  FigureLayout out{.width = inner + 2 * gap};
  int top = gap;
  if (!title.lines.empty()) top = lay(title, gap, top, out.lines) + gap;
  for (const Row& row : rows) {
    int left = gap;
    for (const Placed& p : row) {
      const Rgba8Image& picture = p.panel->picture;
      out.images.push_back({&picture, left, top, !picture.empty() && !fades_into_paper(picture, style.paper)});
      const int below = lay(p.heading, left, top + picture.height() + caption_gap, out.lines);
      lay(p.text, left, below, out.lines);
      left += p.width() + gap;
    }
    top += height_of(row, caption_gap) + gap;
  }
  if (!text.lines.empty()) top = lay(text, gap, top, out.lines) + gap;
  out.height = top;
  return out;
}

Rgba8 outline_color(const FigureStyle& style) {
  return laid_over({style.paper.r, style.paper.g, style.paper.b, 255}, style.ink, hairline_share);
}

}  // namespace zoneplate
