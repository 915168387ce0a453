// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/math/vec.h"
#include "zoneplate/report/figure.h"

namespace zoneplate {

/// A figure on a page.
struct FigurePage {
  Figure figure;
  FigureStyle style;
  int2 size{0, 0};  ///< pixels of the page, in whose middle the figure lies; 0, 0: those of the figure
};

/// The page as an SVG file: texts are outlines of their letters, whose line is the label of its element, and images
/// are embedded PNGs, displayed without interpolation. One user unit is a pixel.
///
/// Exact     the same bytes with the same versions of the fonts and of FreeType.
/// Errors    those of compose.
std::string figure_svg(const FigurePage& page);

/// The pages as a PDF file (version 1.4), with texts as outlines and images without loss. A pixel is 1/96 inch.
///
/// Exact     no time stamp; the same bytes with the same versions of the fonts, FreeType and zlib.
/// Errors    those of compose.
std::vector<std::uint8_t> figures_pdf(std::span<const FigurePage> pages);

}  // namespace zoneplate
