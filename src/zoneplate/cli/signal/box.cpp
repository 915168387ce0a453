// SPDX-License-Identifier: Apache-2.0
// zoneplate signal box: boxes and their spectra.
#include "zoneplate/imaging/signal/box.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

constexpr int max_width = 999;

Syntax make_syntax(BoxOptions& args) {
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
                     [&](auto& text) { args.widths = parse_whole_list(text, 1, max_width); }}};
  for (Option& option : output_options(args, "The plots to write: a .svg or .png file, or - for PNG on stdout"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_signal_box(std::span<const std::string> arguments) {
  BoxOptions args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (!syntax.found_operands.empty()) throw Error(ErrorKind::Usage, "signal box takes no operands: --widths 3,7,15");
  check_plot_name(args.output);
  run_subcommand(args, {}, {}, [&](Delivery& out) { plot_boxes(args, out); });
}

}  // namespace zoneplate::cli
