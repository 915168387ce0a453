// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/report/figure.h"
#include "zoneplate/report/typeface.h"

namespace zoneplate {

/// Where the parts of a figure lie, in pixels from its top left corner.
struct FigureLayout {
  struct Line {
    Typeface::Weight weight = Typeface::Weight::Regular;
    int px = 0;  ///< font size
    int left = 0, top = 0, baseline = 0;
    std::string text;
  };
  struct Image {
    const Rgba8Image* picture = nullptr;  ///< of the figure that is laid out
    int left = 0, top = 0;
    bool has_outline = false;  ///< its border differs from the background colour
  };

  int width = 0, height = 0;
  std::vector<Image> images;
  std::vector<Line> lines;
};

/// Errors    those of Typeface.
FigureLayout lay_out(const Figure& figure, const FigureStyle& style);

/// The colour of images' outlines.
Rgba8 outline_color(const FigureStyle& style);

}  // namespace zoneplate
