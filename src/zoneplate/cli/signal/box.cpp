// SPDX-License-Identifier: Apache-2.0
// zoneplate signal box: boxes and their spectra.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/job/values.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate::cli {
namespace {

constexpr int greatest_width = 999;
constexpr int steps = 2000;              // points of a curve
constexpr double half_power = 0.442946;  // sinc(x)² = ½

struct BoxArgs : SignalArgs {
  std::vector<int> widths = {3, 7, 15};
};

Kernel box_of(int width) { return make_kernel(fmt::format("box:width={}", width)); }

Plot kernels_plot(const BoxArgs& args) {
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

Plot responses_plot(const BoxArgs& args) {
  Plot plot{.title = "Their spectra",
            .x = {"frequency (cycles per pixel)", 0, 0.5},
            .y = {"response", -0.3, 1.05},
            .curves = {}};
  for (const int width : args.widths) {
    const Kernel box = box_of(width);
    Curve curve{fmt::format("first zero at 1/{}", width), {}, Curve::Mark::Line};
    for (int i = 0; i <= steps; ++i) curve.points.emplace_back(0.5 * i / steps, box.response(0.5 * i / steps));
    plot.curves.push_back(std::move(curve));
  }
  plot.curves.push_back({"", {{0, 0}, {0.5, 0}}, Curve::Mark::Dashed, Curve::grey});
  return plot;
}

Syntax make_syntax(BoxArgs& args) {
  Syntax syntax{
      .verb = "signal box",
      .summary = "Plot box filters and their spectra: wider in space, narrower in frequency",
      .operands = "--widths W,...",
      .examples =
          "  zoneplate signal box --widths 3,7,15 -o boxes.svg\n"
          "  zoneplate signal box --widths 2,4 --json\n",
      .notes =
          "The mean over a box of w pixels is a low-pass filter with response sinc(w f) = sin(pi w f)/(pi w f).\n"
          "It is 0 where a whole number of periods fits into the box, first at f = 1/w: the product of width\n"
          "and first zero is always 1. Between the zeros are side lobes; where the response is negative, light\n"
          "and dark are exchanged.\n"};
  syntax.options = {{"--widths", "W,...", "Widths in pixels; default 3,7,15", "Options", true,
                     [&](auto& text) { args.widths = parse_whole_list(text, 1, greatest_width); }}};
  for (Option& option : output_options(args, "The plots to write: a .svg or .png file, or - for PNG on stdout"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_signal_box(std::span<const std::string> arguments) {
  BoxArgs args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (!syntax.found_operands.empty()) throw Error(ErrorKind::Usage, "signal box takes no operands: --widths 3,7,15");
  check_plot_name(args.output);
  std::string text = "  width (pixels)   first zero   half power at   response at 1/2 (cycles per pixel)\n";
  Json::Array rows;
  for (const int width : args.widths) {
    const double zero = 1.0 / width, half = half_power / width, at_nyquist = box_of(width).response(0.5);
    text += fmt::format("  {:<17}{:<13.6f}{:<16.6f}{:.6f}\n", width, zero, half, at_nyquist);
    rows.emplace_back(Json::Object{
        {"width", width}, {"first_zero", zero}, {"half_power", half}, {"response_at_nyquist", at_nyquist}});
  }
  run_subcommand(args, {}, {}, [&](Delivery& out) {
    if (!args.output.empty()) out.save_plots(args.output, std::vector{kernels_plot(args), responses_plot(args)}, 2, {});
    print_result(args, text, {{"output", args.output}, {"boxes", rows}}, out);
  });
}

}  // namespace zoneplate::cli
