// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/box.h"

#include <fmt/format.h>
#include <algorithm>

#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate {
namespace {

constexpr int response_steps = 2000;     // points of a curve
constexpr double half_power = 0.442946;  // sinc(x)² = ½

Kernel box_of(int width) { return make_kernel(fmt::format("box:width={}", width)); }

Plot kernels_plot(const BoxOptions& args) {
  const double reach = 0.6 * *std::max_element(args.widths.begin(), args.widths.end());
  const int narrowest = *std::min_element(args.widths.begin(), args.widths.end());
  Plot plot{.title = "Box filters, each of area 1",
            .x = {"position (pixels)", -reach, reach},
            .y = {"weight", 0, 1.15 / narrowest},
            .curves = {}};
  for (const int width : args.widths) {
    const double half = width / 2.0, height = box_of(width).value(0);
    plot.curves.push_back({fmt::format("{} pixels wide", width),
                           {{-reach, 0}, {-half, 0}, {-half, height}, {half, height}, {half, 0}, {reach, 0}}});
  }
  return plot;
}

Plot responses_plot(const BoxOptions& args) {
  Plot plot{.title = "Their spectra",
            .x = {"frequency (cycles per pixel)", 0, 0.5},
            .y = {"response", -0.3, 1.05},
            .curves = {}};
  for (const int width : args.widths) {
    const Kernel box = box_of(width);
    Curve curve{fmt::format("first zero at 1/{}", width), {}, Curve::Mark::Line};
    for (int i = 0; i <= response_steps; ++i)
      curve.points.emplace_back(0.5 * i / response_steps, box.response(0.5 * i / response_steps));
    plot.curves.push_back(std::move(curve));
  }
  plot.curves.push_back({"", {{0, 0}, {0.5, 0}}, Curve::Mark::Dashed, Curve::grey});
  return plot;
}

}  // namespace

void plot_boxes(const BoxOptions& args, Delivery& out) {
  std::string text = "  width (pixels)   first zero   half power at   response at 1/2 (cycles per pixel)\n";
  Json::Array rows;
  for (const int width : args.widths) {
    const double zero = 1.0 / width, half = half_power / width, at_nyquist = box_of(width).response(0.5);
    text += fmt::format("  {:<17}{:<13.6f}{:<16.6f}{:.6f}\n", width, zero, half, at_nyquist);
    rows.emplace_back(Json::Object{
        {"width", width}, {"first_zero", zero}, {"half_power", half}, {"response_at_nyquist", at_nyquist}});
  }
  if (!args.output.empty()) out.save_plots(args.output, std::vector{kernels_plot(args), responses_plot(args)}, 2, {});
  print_result(args, text, {{"output", args.output}, {"boxes", rows}}, out);
}

}  // namespace zoneplate
