// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/image/hex_color.h"
#include "zoneplate/os/run_program.h"

namespace zoneplate {
namespace {

// Sizes in pixels for a plot of the default size; texts are legible at half of these sizes.
constexpr int text_px = 17, title_px = 20, label_px = 12;
constexpr int margin_px = 10, heading_px = 30, key_row_px = 22, sample_px = 46, axes_px = 100;
constexpr double letter_em = 0.58;  // mean width of a letter of DejaVu Sans
constexpr double line_px = 2.4, dash_px = 1.6, point_size = 1.1;

/// A gnuplot terminal, and the sizes in its units that result in the same layout for all terminals.
struct Terminal {
  const char* name;
  const char* more;
  double font;         ///< units per pixel: SVG uses pixels, Cairo points at 96 dots per inch
  double point;        ///< factor of a mark's size
  double key_spacing;  ///< spacing for rows of key_row_px
};
constexpr Terminal svg = {"svg", "dynamic", 1, 0.55, 0.86}, cairo = {"pngcairo", "", 0.75, 1, 1.12};

// A gnuplot string in single quotes, in which no characters are special; single quotes in the text are replaced.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    const bool is_control = static_cast<unsigned char>(c) < 32 || c == 127;
    out += c == '\'' ? "’" : is_control ? " " : std::string(1, c);
  }
  return out + '\'';
}

// A gnuplot string in double quotes for a data block, in which no characters are special; double quotes in the text are
// replaced.
std::string label_of(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const bool is_plain = static_cast<unsigned char>(c) >= 32 && c != 127 && c != '"' && c != '\\';
    out += is_plain ? c : ' ';
  }
  return out + '"';
}

// The part of a plot command that draws one curve from the data block of this name.
std::string marks_of(const Curve& curve, const std::string& block, std::size_t place, const Terminal& terminal) {
  using Mark = Curve::Mark;
  const std::string color = hex_color(curve_color(curve, place));
  const std::string title = curve.name.empty() ? "notitle" : "title " + quoted(curve.name);
  const double point = point_size * terminal.point;
  const auto line = [&](double width) { return fmt::format("lw {} lc rgb '{}'", width, color); };
  const auto with = [&](const std::string& style, const std::string& name) {
    return fmt::format("{} using 1:2 with {} {}", block, style, name);
  };
  switch (curve.mark) {
    case Mark::Line:
      return with("lines " + line(line_px), title);
    case Mark::Dashed:
      return with("lines dt (9,7) " + line(dash_px), title);
    case Mark::Points:
      return with(fmt::format("points pt 7 ps {} lc rgb '{}'", point, color), title);
    case Mark::LineAndPoints:
      return with(fmt::format("linespoints pt 7 ps {} {}", 0.7 * point, line(line_px)), title);
    case Mark::Stems:
      return with("impulses " + line(line_px), "notitle") + ", " +
             with(fmt::format("points pt 7 ps {} lc rgb '{}'", point, color), title);
    case Mark::Steps:
      return with("steps " + line(line_px), title);
    case Mark::Area:
      break;
  }
  return with(fmt::format("filledcurves y1=0 fs transparent solid {} noborder lc rgb '{}'", curve.opacity, color),
              title) +
         ", " + with("lines " + line(dash_px), "notitle");
}

std::string drawing_of(const Curve& curve, const std::string& block, std::size_t place, const Terminal& terminal) {
  std::string text = marks_of(curve, block, place, terminal);
  constexpr const char* places[] = {"left offset 0.8,0.35", "right offset -0.8,-0.45", "right offset -0.8,0.35"};
  const char* place_of_labels = places[static_cast<std::size_t>(curve.labels_are)];
  if (!curve.labels.empty())
    text += fmt::format(", {} using 1:2:3 with labels {} font 'DejaVu Sans,{}' textcolor rgb '{}' notitle", block,
                        place_of_labels, label_px * terminal.font, hex_color(curve_color(curve, place)));
  return text;
}

/// Ticks at 1, 2 and 5 of each decade if a logarithmic axis would have too few ticks at decades alone.
std::string ticks_of(char name, const Axis& axis) {
  if (!axis.is_logarithmic || !(axis.low > 0) || axis.high >= 1000 * axis.low)
    return fmt::format("set {}tics autofreq\n", name);
  std::string places;
  double decade = 1;
  while (decade > axis.low) decade /= 10;
  while (10 * decade <= axis.low) decade *= 10;
  for (; decade <= axis.high; decade *= 10)
    for (const int step : {1, 2, 5})
      if (step * decade >= axis.low && step * decade <= axis.high)
        places += fmt::format("{}{:.6g}", places.empty() ? "" : ", ", step * decade);
  return places.empty() ? fmt::format("set {}tics autofreq\n", name) : fmt::format("set {}tics ({})\n", name, places);
}

std::string axis_of(char name, const Axis& axis) {
  std::string text = fmt::format("set {}label {}\n", name, quoted(axis.label)) + ticks_of(name, axis);
  text += axis.is_logarithmic ? fmt::format("set logscale {0}\nset format {0} '%g'\n", name)
                              : fmt::format("unset logscale {0}\nset format {0} '%g'\n", name);
  text += axis.low == 0 && axis.high == 0 ? fmt::format("set autoscale {}\n", name)
                                          : fmt::format("set {}range [{}:{}]\n", name, axis.low, axis.high);
  return text;
}

// Data have 10 digits: far more than an image resolves, and few enough to hide errors in the last bits.
std::string data_of(const Curve& curve, const std::string& block) {
  std::string text = block + " << EOD\n";
  assert(curve.labels.empty() || curve.labels.size() == curve.points.size());
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const auto& [x, y] = curve.points[i];
    const bool is_there = std::isfinite(x) && std::isfinite(y);
    text += is_there ? fmt::format("{:.10g} {:.10g}", x, y) : "";
    if (is_there && !curve.labels.empty()) text += ' ' + label_of(curve.labels[i]);
    text += '\n';
  }
  return text + "EOD\n";
}

// The layout of the key: columns as wide as its longest name.
struct Key {
  int columns = 1, rows = 0;
};
Key key_of(const Plot& plot, int width) {
  std::size_t longest = 0;
  int names = 0;
  for (const Curve& curve : plot.curves) {
    if (curve.name.empty() || curve.points.empty()) continue;
    const auto is_start = [](char c) {
      return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    };  // the number of letters, in UTF-8
    longest =
        std::max(longest, static_cast<std::size_t>(std::count_if(curve.name.begin(), curve.name.end(), is_start)));
    ++names;
  }
  if (names == 0) return {};
  const double column = sample_px + (static_cast<double>(longest) + 2) * letter_em * text_px;
  const int columns = std::clamp(static_cast<int>((width - axes_px) / column), 1, names);
  return {columns, (names + columns - 1) / columns};
}

// The title and key above a plot; the plot's top is `top` pixels below the top of a sheet of height `height`.
std::string heading_of(const Plot& plot, const PlotSize& size, int top, int height, const Terminal& terminal) {
  const Key key = key_of(plot, size.width);
  const auto from_top = [&](int y) { return fmt::format("screen {:.6f}", 1 - static_cast<double>(top + y) / height); };
  std::string text;
  int y = margin_px;
  if (!plot.title.empty()) {
    text += fmt::format("set label 1 {} at graph 0,{} left font 'DejaVu Sans,{}' textcolor rgb '#202020'\n",
                        quoted(plot.title), from_top(y + heading_px / 2), title_px * terminal.font);
    y += heading_px;
  }
  text += key.rows == 0 ? "unset key\n"
                        : fmt::format(
                              "set key at graph 0,{} left top Left reverse horizontal maxcols {} samplen 1.6 "
                              "spacing {} textcolor rgb '#303030'\n",
                              from_top(y), key.columns, terminal.key_spacing);
  return text + fmt::format("set tmargin at {}\n", from_top(y + key.rows * key_row_px + margin_px));
}

std::string body_of(const Plot& plot, std::size_t number, const Terminal& terminal) {
  std::string text = axis_of('x', plot.x) + axis_of('y', plot.y);
  std::string drawings;
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    if (plot.curves[i].points.empty()) continue;
    const std::string block = fmt::format("$d{}_{}", number, i);
    text += data_of(plot.curves[i], block);
    drawings += (drawings.empty() ? "" : ", ") + drawing_of(plot.curves[i], block, i, terminal);
  }
  return text + "plot " + (drawings.empty() ? "NaN notitle" : drawings) + "\nunset label 1\n";
}

// The common style of all plots: a light grid, two axes instead of a frame, the key above the curves.
std::string style_of(const Terminal& terminal, int width, int height) {
  return fmt::format(
      "set encoding utf8\n"
      "set terminal {} size {},{} font 'DejaVu Sans,{}' background '#ffffff' rounded noenhanced {}\n"
      "set minussign\n"
      "set border 3 lw 1 lc rgb '#606060'\n"
      "set tics out nomirror scale 0.6 textcolor rgb '#303030'\n"
      "set grid lw 1 lc rgb '#e6e6e6' lt 1\n"
      "set xlabel textcolor rgb '#303030'\nset ylabel textcolor rgb '#303030'\n"
      "set rmargin 3\n",
      terminal.name, width, height, text_px * terminal.font, terminal.more);
}

// The input of gnuplot.
std::string script_of(std::span<const Plot> plots, int columns, const PlotSize& size, const Terminal& terminal) {
  assert(!plots.empty() && columns >= 1);
  const int count = static_cast<int>(plots.size()), rows = (count + columns - 1) / columns;
  std::string text = style_of(terminal, size.width * std::min(columns, count), size.height * rows);
  if (count > 1) text += fmt::format("set multiplot layout {},{}\n", rows, std::min(columns, count));
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const int row = static_cast<int>(i) / columns;
    text +=
        heading_of(plots[i], size, row * size.height, rows * size.height, terminal) + body_of(plots[i], i, terminal);
  }
  return text + (count > 1 ? "unset multiplot\n" : "");
}

std::vector<std::uint8_t> drawn(std::span<const Plot> plots, int columns, const PlotSize& size,
                                const Terminal& terminal, int milliseconds) {
  // `-d` ignores initialization files of the machine and the user.
  const ProgramResult answer = [&] {
    try {
      return run_child("gnuplot", {"-d", "-"}, script_of(plots, columns, size, terminal),
                       {.milliseconds = milliseconds});
    } catch (const Error& error) {
      throw Error(ErrorKind::Failed, std::string(error.what()) + "; plots need it (Debian's package gnuplot-nox)");
    }
  }();
  if (answer.code != 0 || answer.out.empty())
    throw Error(ErrorKind::Failed,
                fmt::format("gnuplot (Debian's package gnuplot-nox): exit code {}: {}", answer.code, answer.complaint));
  return answer.out;
}

}  // namespace

std::string plots_svg(std::span<const Plot> plots, int columns, const PlotSize& size, int milliseconds) {
  const std::vector<std::uint8_t> bytes = drawn(plots, columns, size, svg, milliseconds);
  return {bytes.begin(), bytes.end()};
}

Rgba8Image plots_picture(std::span<const Plot> plots, int columns, const PlotSize& size, int milliseconds) {
  return decode_png(drawn(plots, columns, size, cairo, milliseconds), "the plot").pixels;
}

std::string plot_svg(const Plot& plot, const PlotSize& size, int milliseconds) {
  return plots_svg({&plot, 1}, 1, size, milliseconds);
}
Rgba8Image plot_picture(const Plot& plot, const PlotSize& size, int milliseconds) {
  return plots_picture({&plot, 1}, 1, size, milliseconds);
}

}  // namespace zoneplate
