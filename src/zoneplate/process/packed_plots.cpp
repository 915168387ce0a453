// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/packed_plots.h"

#include <algorithm>
#include <cstring>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/run_program.h"
#include "zoneplate/process/packed.h"

namespace zoneplate {
namespace {

void pack(const Axis& axis, Packer& out) {
  out.text(axis.label);
  out.value(axis.low), out.value(axis.high), out.value(axis.is_logarithmic);
}

void pack(const Plot& plot, Packer& out) {
  out.text(plot.title);
  pack(plot.x, out), pack(plot.y, out);
  out.value(std::uint64_t{plot.curves.size()});
  for (const Curve& curve : plot.curves) {
    out.text(curve.name);
    out.value(curve.mark), out.value(curve.color), out.value(curve.opacity), out.value(curve.labels_are);
    out.value(std::uint64_t{curve.points.size()});
    for (const auto& [x, y] : curve.points) out.value(x), out.value(y);
    out.value(std::uint64_t{curve.labels.size()});
    for (const std::string& label : curve.labels) out.text(label);
  }
}

void pack(const Panel& panel, Packer& out) {
  out.text(panel.caption);
  out.value(panel.picture.width()), out.value(panel.picture.height());
  for (const Rgba8 c : panel.picture.values()) out.value(c);
  out.value(panel.plot.has_value());
  if (panel.plot) pack(*panel.plot, out);
}

[[noreturn]] void refuse() { throw Error(ErrorKind::Failed, "a process sent plots that are not valid"); }

/// Deserializes plots, whose numbers are checked.
class PlotReader {
 public:
  explicit PlotReader(std::span<const std::uint8_t> bytes) : in_(bytes) {}

  PlotsToDraw whole() {
    PlotsToDraw out;
    out.columns = whole_number(1, 8);
    out.size = {whole_number(1, 2000), whole_number(1, 2000)};
    for (std::uint64_t n = count(16); n > 0; --n) out.plots.push_back(plot());
    if (!flag()) {
      if (out.plots.empty()) refuse();
      return out;
    }
    Figure& figure = out.figure.emplace();
    figure.title = in_.text(), figure.text = in_.text();
    for (std::uint64_t n = count(16); n > 0; --n) {
      figure.rows.emplace_back();
      for (std::uint64_t m = count(16); m > 0; --m) figure.rows.back().push_back(panel());
    }
    return out;
  }

 private:
  int whole_number(int low, int high) {
    const int number = in_.value<int>();
    if (number < low || number > high) refuse();
    return number;
  }
  std::uint64_t count(std::uint64_t most) {
    const auto number = in_.value<std::uint64_t>();
    if (number > most) refuse();
    return number;
  }
  bool flag() { return in_.value<std::uint8_t>() != 0; }

  Axis axis() {
    Axis axis{.label = in_.text()};
    axis.low = in_.value<double>(), axis.high = in_.value<double>(), axis.is_logarithmic = flag();
    return axis;
  }
  Plot plot() {
    Plot plot{.title = in_.text()};
    plot.x = axis(), plot.y = axis();
    for (std::uint64_t n = count(1000); n > 0; --n) plot.curves.push_back(curve());
    return plot;
  }
  Curve curve() {
    Curve curve{.name = in_.text()};
    curve.mark = static_cast<Curve::Mark>(whole_number(0, static_cast<int>(Curve::Mark::Area)));
    curve.color = whole_number(Curve::grey, 1000);
    curve.opacity = in_.value<double>();
    curve.labels_are = static_cast<Curve::Beside>(whole_number(0, static_cast<int>(Curve::Beside::LeftAbove)));
    constexpr std::uint64_t max_points = 1 << 20;
    for (std::uint64_t n = count(max_points); n > 0; --n) {
      const double x = in_.value<double>(), y = in_.value<double>();
      curve.points.emplace_back(x, y);
    }
    const std::uint64_t labels = count(curve.points.size());
    if (labels != 0 && labels != curve.points.size()) refuse();
    for (std::uint64_t n = labels; n > 0; --n) curve.labels.push_back(in_.text());
    return curve;
  }
  Panel panel() {
    constexpr int max_side = 4096;
    Panel panel{.picture = {}, .caption = in_.text()};
    const int width = whole_number(0, max_side), height = whole_number(0, max_side);
    if (width > 0 && height > 0) panel.picture = Rgba8Image(width, height);
    for (Rgba8& c : panel.picture.values()) c = in_.value<Rgba8>();
    if (flag()) panel.plot = plot();
    return panel;
  }

  Unpacker in_;
};

}  // namespace

std::vector<std::uint8_t> pack_plots(const PlotsToDraw& plots) {
  Packer out;
  out.value(plots.columns), out.value(plots.size.width), out.value(plots.size.height);
  out.value(std::uint64_t{plots.plots.size()});
  for (const Plot& plot : plots.plots) pack(plot, out);
  out.value(plots.figure.has_value());
  if (!plots.figure) return std::move(out).bytes();
  out.text(plots.figure->title), out.text(plots.figure->text);
  out.value(std::uint64_t{plots.figure->rows.size()});
  for (const std::vector<Panel>& row : plots.figure->rows) {
    out.value(std::uint64_t{row.size()});
    for (const Panel& panel : row) pack(panel, out);
  }
  return std::move(out).bytes();
}

PlotsToDraw unpack_plots(std::span<const std::uint8_t> bytes) { return PlotReader(bytes).whole(); }

std::vector<std::uint8_t> drawn_plots(PlotsToDraw plots, const std::string& path, double seconds) {
  const Stopwatch watch;
  const auto milliseconds = [&] {
    const double left = std::min<double>(ProgramLimits().milliseconds, seconds * 1000 - watch.ms());
    return std::max(1, static_cast<int>(left));
  };
  if (plots.figure) {
    for (std::vector<Panel>& row : plots.figure->rows)
      for (Panel& panel : row)
        if (panel.plot && panel.picture.empty()) panel.picture = plot_picture(*panel.plot, plots.size, milliseconds());
    return encode_png(compose(*plots.figure), {.has_alpha = false});
  }
  if (!path.ends_with(".svg"))
    return encode_png(plots_picture(plots.plots, plots.columns, plots.size, milliseconds()), {.has_alpha = false});
  const std::string svg = plots_svg(plots.plots, plots.columns, plots.size, milliseconds());
  return {svg.begin(), svg.end()};
}

}  // namespace zoneplate
