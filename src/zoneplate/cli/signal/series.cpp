// SPDX-License-Identifier: Apache-2.0
// zoneplate signal series: a wave as the sum of its harmonics.
#include "zoneplate/imaging/signal/series.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

constexpr int max_term = 9999;

Syntax make_syntax(SeriesOptions& args) {
  Syntax syntax{
      .verb = "signal series",
      .summary = "Plot partial sums of the Fourier series of a wave",
      .operands = "square|triangle|sawtooth",
      .examples =
          "  zoneplate signal series square --terms 1,3,5,15 -o series.svg\n"
          "  zoneplate signal series triangle --terms 1,3,9 -o triangle.png\n"
          "  zoneplate signal series sawtooth --terms 100,1000 --json\n",
      .notes =
          "Each wave is a sum of sines of 1, 2, 3, ... cycles per period; square and triangle have odd harmonics\n"
          "only. At a discontinuity the amplitudes fall as slowly as 1/n, and every partial sum overshoots by\n"
          "8.949 % of the jump in the limit (Gibbs phenomenon). The triangle is continuous: its amplitudes fall\n"
          "as 1/n², without overshoot. An edge in an image is such a discontinuity: it is not band-limited.\n"};
  syntax.options = {{"--terms", "N,...", "Highest harmonic of each sum; default 1,3,5,15", "Options", true,
                     [&](auto& text) { args.terms = parse_whole_list(text, 1, max_term); }}};
  for (Option& option : output_options(args, "The plot to write: a .svg or .png file, or - for PNG on stdout"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_signal_series(std::span<const std::string> arguments) {
  SeriesOptions args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const Wave wave = parse_wave(only_operand(syntax, "a wave: square, triangle or sawtooth"));
  check_plot_name(args.output);
  run_subcommand(args, {}, {}, [&](Delivery& out) { plot_series(wave, args, out); });
}

}  // namespace zoneplate::cli
