// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// One curve of a plot.
///
/// Edges     a point that is not finite interrupts the line.
struct Curve {
  enum class Mark {
    Line,
    Dashed,  ///< thinner, and behind the other curves: for references and limits
    Points,
    LineAndPoints,
    Stems,  ///< a line from 0 to each point
    Steps,  ///< horizontal from each point to the next
    Area,   ///< lightly filled down to 0, with an outline
  };

  std::string name;  ///< name in the key; empty: not in the key
  std::vector<std::pair<double, double>> points;
  Mark mark = Mark::Line;
  /// Index into the palette; -1: the index of the curve; `grey`: for background information.
  int color = -1;
  double opacity = 0.25;                 ///< opacity of an Area
  std::vector<std::string> labels = {};  ///< texts next to the points: one per point (some may be empty), or none
  enum class Beside { RightAbove, LeftBelow, LeftAbove } labels_are = Beside::RightAbove;
  static constexpr int grey = -2;
};

struct Axis {
  std::string label;  ///< with its unit: "frequency (cycles per pixel)"
  /// Both 0: the range of the data. A logarithmic axis of less than three decades has ticks at 1, 2 and 5.
  double low = 0, high = 0;
  bool is_logarithmic = false;
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
};

struct PlotSize {
  int width = 720, height = 440;  ///< pixels of the PNG; the SVG has the same aspect ratio
};

/// Leaves out the labels that would lie over one to their left or below, by the width of an average letter.
///
/// Requires  `x` and `y` have their ranges.
void thin_labels(std::span<Curve> curves, const Axis& x, const Axis& y);

/// Draws the plot as the text of an SVG file, or as an image; legible at half size.
///
/// The plot is drawn by gnuplot in a child process, in `milliseconds` at most. Texts are unchanged, except that '
/// becomes ’.
/// Exact     no time stamp; the same bytes with the same versions of gnuplot and its fonts.
/// Errors    ErrorKind::Failed naming gnuplot and its package if it is not installed or fails.
///           Where there is no gnuplot, as in a page, a picture may be empty.
std::string plot_svg(const Plot& plot, const PlotSize& size = {}, int milliseconds = 20000);
Rgba8Image plot_picture(const Plot& plot, const PlotSize& size = {}, int milliseconds = 20000);

/// Several plots of this size each, `columns` side by side, row by row.
///
/// Requires  plots are not empty, columns >= 1.
std::string plots_svg(std::span<const Plot> plots, int columns, const PlotSize& size = {}, int milliseconds = 20000);
Rgba8Image plots_picture(std::span<const Plot> plots, int columns, const PlotSize& size = {}, int milliseconds = 20000);

/// A palette for colour-blind readers, in the order of the curves.
///
/// Source    Okabe and Ito, Color Universal Design, 2008; without its yellow, which is hardly visible on white.
std::span<const Rgba8> plot_palette();

/// The colour of the curve at this place of a plot.
Rgba8 curve_color(const Curve& curve, std::size_t place);

}  // namespace zoneplate
