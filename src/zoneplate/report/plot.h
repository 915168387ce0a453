#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// One curve of a plot.
struct Curve {
  enum class Mark { Line, Points, LineAndPoints, Stems, Steps };

  std::string name;  ///< in the key; empty: none
  std::vector<std::pair<double, double>> points;
  Mark mark = Mark::Line;
};

struct Axis {
  std::string label;         ///< with its unit: "frequency (cycles per pixel)"
  double low = 0, high = 0;  ///< both 0: as the data want
  bool is_logarithmic = false;
};

struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Curve> curves;
};

struct PlotSize {
  int width = 720, height = 440;  ///< pixels of the PNG; the SVG has the same shape
};

/// The plot as the text of an SVG file, or as a picture; legible at half size.
///
/// Drawn by gnuplot, a program of its own, in a child process with a time limit.
/// Errors    Trouble::Failed naming gnuplot and its package where it is not installed or does not answer.
std::string plot_svg(const Plot& plot, const PlotSize& size = {});
Rgba8Image plot_picture(const Plot& plot, const PlotSize& size = {});

}  // namespace zoneplate
