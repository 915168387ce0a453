// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/figure.h"

#include <algorithm>
#include <utility>

#include "zoneplate/report/typeface.h"

namespace zoneplate {
namespace {

constexpr int least_width_em = 20;   // minimum width of a figure, so that a title fits over a small image
constexpr int hairline_share = 110;  // of 255: darkness of an image's outline
constexpr double title_scale = 1.5;  // documented in the header

struct Faces {
  explicit Faces(const FigureStyle& style)
      : text(Typeface::Weight::Regular, style.text_px),
        heading(Typeface::Weight::Bold, style.text_px),
        title(Typeface::Weight::Bold, static_cast<int>(title_scale * style.text_px + 0.5)) {}
  Typeface text, heading, title;
};

/// A text broken into lines, ready to be drawn.
struct Block {
  const Typeface* face = nullptr;
  std::vector<std::string> lines;

  int height() const { return static_cast<int>(lines.size()) * face->leading(); }
};

/// A panel whose caption is broken into lines; if the caption itself has several lines, the first is a heading.
struct Placed {
  const Panel* panel = nullptr;
  Block heading, text;

  int width() const { return panel->picture.width(); }
};

Block block(const Typeface& face, std::string_view text, int width) { return {&face, face.wrapped(text, width)}; }

Placed placed(const Faces& faces, const Panel& panel) {
  const std::string_view caption = panel.caption;
  const std::size_t end = caption.find('\n');
  const bool has_heading = end != std::string_view::npos;
  const int width = panel.picture.width();
  return {&panel, block(faces.heading, has_heading ? caption.substr(0, end) : std::string_view{}, width),
          block(faces.text, has_heading ? caption.substr(end + 1) : caption, width)};
}

/// The image of the figure, which is drawn from top to bottom.
class Sheet {
 public:
  Sheet(int width, int height, const FigureStyle& style) : image_(width, height, opaque(style.paper)), style_(style) {}

  int lay(const Block& block, int left, int top) {
    for (const std::string& line : block.lines) {
      block.face->draw(image_, left, top, line, style_.ink);
      top += block.face->leading();
    }
    return top;
  }

  int lay(const Rgba8Image& picture, int left, int top) {
    if (!picture.empty() && !fades_into_paper(picture)) outline(picture, left, top);
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) {
        const Rgba8 c = picture(x, y);
        image_(left + x, top + y) = c.a == 255 ? c : laid_over(image_(left + x, top + y), c, 255);
      }
    return top + picture.height();
  }

  Rgba8Image take() { return std::move(image_); }

 private:
  static Rgba8 opaque(Rgba8 c) { return {c.r, c.g, c.b, 255}; }

  /// True for an image whose border has the background colour, such as a plot.
  bool fades_into_paper(const Rgba8Image& picture) const {
    const auto is_paper = [&](Rgba8 c) { return c.a == 0 || c == opaque(style_.paper); };
    const int w = picture.width(), h = picture.height();
    for (int x = 0; x < w; ++x)
      if (!is_paper(picture(x, 0)) || !is_paper(picture(x, h - 1))) return false;
    for (int y = 0; y < h; ++y)
      if (!is_paper(picture(0, y)) || !is_paper(picture(w - 1, y))) return false;
    return true;
  }

  /// Draws an outline of one pixel around the image, so that the edges of light images are visible.
  void outline(const Rgba8Image& picture, int left, int top) {
    const Rgba8 line = laid_over(opaque(style_.paper), style_.ink, hairline_share);
    const auto set = [&](int x, int y) {
      if (x >= 0 && y >= 0 && x < image_.width() && y < image_.height()) image_(x, y) = line;
    };
    const int right = left + picture.width(), bottom = top + picture.height();
    for (int x = left - 1; x <= right; ++x) set(x, top - 1), set(x, bottom);
    for (int y = top - 1; y <= bottom; ++y) set(left - 1, y), set(right, y);
  }

  Rgba8Image image_;
  const FigureStyle& style_;
};

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

}  // namespace

Rgba8Image compose(const Figure& figure, const FigureStyle& style) {
  const Faces faces(style);
  const int gap = style.gap_px, caption_gap = gap / 2;
  std::vector<Row> rows;
  int inner = least_width_em * style.text_px;
  for (const std::vector<Panel>& panels : figure.rows) {
    Row& row = rows.emplace_back();
    for (const Panel& panel : panels) row.push_back(placed(faces, panel));
    inner = std::max(inner, width_of(row, gap));
  }
  const Block title = block(faces.title, figure.title, inner), text = block(faces.text, figure.text, inner);

  // Each element is followed by a gap; the first gap is the top margin.
  int height = gap;
  for (const Block* b : {&title, &text})
    if (!b->lines.empty()) height += b->height() + gap;
  for (const Row& row : rows) height += height_of(row, caption_gap) + gap;

  Sheet sheet(inner + 2 * gap, height, style);
  int top = gap;
  if (!title.lines.empty()) top = sheet.lay(title, gap, top) + gap;
  for (const Row& row : rows) {
    int left = gap;
    for (const Placed& p : row) {
      const int below = sheet.lay(p.panel->picture, left, top) + caption_gap;
      sheet.lay(p.text, left, sheet.lay(p.heading, left, below));
      left += p.width() + gap;
    }
    top += height_of(row, caption_gap) + gap;
  }
  sheet.lay(text, gap, top);
  return sheet.take();
}

Rgba8Image enlarged(const Rgba8Image& picture, int factor) {
  Rgba8Image large(picture.width() * factor, picture.height() * factor);
  for (int y = 0; y < large.height(); ++y)
    for (int x = 0; x < large.width(); ++x) large(x, y) = picture(x / factor, y / factor);
  return large;
}

}  // namespace zoneplate
