#pragma once

#include <string>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// One picture of a figure, with the line or two below it that say what it shows.
struct Panel {
  Rgba8Image picture;
  std::string caption;  ///< UTF-8; wrapped at the picture's width; of several lines, the first is a heading, in bold
};

/// Pictures side by side that explain themselves: a title, rows of panels, and a text below.
struct Figure {
  std::string title;
  std::vector<std::vector<Panel>> rows;  ///< row by row; pictures of one row may differ in size
  std::string text;                      ///< wrapped at the figure's width, a line end starts a new line
};

struct FigureStyle {
  int text_px = 15;                 ///< height of the letters of captions and text; the title's are 1.5 times as high
  int gap_px = 16;                  ///< between panels, and around all of them
  Rgba8 paper{255, 255, 255, 255};  ///< behind everything
  Rgba8 ink{32, 32, 32, 255};
};

/// The figure as one picture, as wide as its widest row (and at least 20 `text_px`).
///
/// Pictures keep their pixels. One whose rim is not paper gets an outline of one pixel around it.
/// Exact     the same bits on every machine with the same versions of the font and of FreeType.
/// Errors    ErrorKind::Failed naming the font and its package where it is not installed.
Rgba8Image compose(const Figure& figure, const FigureStyle& style = {});

/// The picture with every pixel `factor` × `factor` times: how a crop is shown, so that single pixels can be judged.
Rgba8Image enlarged(const Rgba8Image& picture, int factor);

}  // namespace zoneplate
