// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/report/plot.h"

namespace zoneplate {

/// One image of a figure, with its caption.
struct Panel {
  Rgba8Image picture;
  /// UTF-8; wrapped at the image's width; if it has several lines, the first is a heading, in bold.
  std::string caption;
  std::optional<Plot> plot = {};  ///< what the picture displays, for media that draw it themselves
};

/// A figure: a title, rows of captioned images, and a text below.
struct Figure {
  std::string title;
  std::vector<std::vector<Panel>> rows;  ///< images of one row may differ in size
  std::string text;                      ///< wrapped at the figure's width; line ends start new lines
};

struct FigureStyle {
  int text_px = 15;                 ///< font size of captions and text; the title is 1.5 times as large
  int gap_px = 16;                  ///< between panels, and around all of them
  Rgba8 paper{255, 255, 255, 255};  ///< background colour
  Rgba8 ink{32, 32, 32, 255};
};

/// Composes a figure to one image, as wide as its widest row (and at least 20 `text_px`).
///
/// Images are not scaled. An image whose border differs from the background colour gets an outline of one pixel.
/// Exact     the same bits on every machine with the same versions of the font and of FreeType.
/// Errors    ErrorKind::Failed naming the font and its package if it is not installed.
Rgba8Image compose(const Figure& figure, const FigureStyle& style = {});

/// The image enlarged by repeating pixels `factor` × `factor` times, so that single pixels of a crop are visible.
Rgba8Image enlarged(const Rgba8Image& picture, int factor);

}  // namespace zoneplate
