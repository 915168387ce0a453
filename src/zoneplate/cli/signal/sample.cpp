// SPDX-License-Identifier: Apache-2.0
// zoneplate signal sample: two waves with the same samples, and the copies of a sampled spectrum.
#include "zoneplate/imaging/signal/sample.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

constexpr double least = 1e-9, greatest = 1e9;

Syntax make_syntax(SampleOptions& args) {
  Syntax syntax{
      .verb = "signal sample",
      .summary = "Sample a sine wave, and plot the other frequencies with the same samples",
      .operands = "--frequency F --rate R",
      .examples =
          "  zoneplate signal sample --frequency 7 --rate 10 -o alias.svg\n"
          "  zoneplate signal sample --frequency 3 --rate 10 -o enough.png\n"
          "  zoneplate signal sample --frequency 0.9 --rate 1     # a wheel of 0.9 spokes a frame\n",
      .notes =
          "At a sampling rate r the frequencies f, f + r, f + 2r, ... and r - f, 2r - f, ... have the same\n"
          "samples: they are aliases, and reconstruction returns the one below r/2. In frequency, sampling\n"
          "replicates the spectrum at every multiple of the rate. If the signal is band-limited below r/2 the\n"
          "replicas do not overlap, and the signal can be reconstructed exactly; otherwise the overlapping\n"
          "frequencies are lost. This is why images are low-pass filtered before they are sampled.\n"};
  const std::string group = "Options";
  syntax.options = {{"--frequency", "F", "Frequency of the wave in Hz", group, true,
                     [&](auto& text) { args.frequency = parse_number(text, least, greatest); }},
                    {"--rate", "R", "Samples per second", group, true,
                     [&](auto& text) { args.rate = parse_number(text, least, greatest); }}};
  for (Option& option : output_options(args, "The plots to write: a .svg or .png file, or - for PNG on stdout"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_signal_sample(std::span<const std::string> arguments) {
  SampleOptions args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (!syntax.found_operands.empty())
    throw Error(ErrorKind::Usage, "signal sample takes no operands: --frequency F --rate R");
  if (args.frequency == 0 || args.rate == 0) throw Error(ErrorKind::Usage, "--frequency and --rate are required");
  if (args.frequency > 1000 * args.rate) throw Error(ErrorKind::Usage, "--frequency is more than 1000 times the rate");
  check_plot_name(args.output);
  run_subcommand(args, {}, {}, [&](Delivery& out) { plot_sampling(args, out); });
}

}  // namespace zoneplate::cli
