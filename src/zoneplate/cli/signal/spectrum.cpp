// SPDX-License-Identifier: Apache-2.0
// zoneplate signal spectrum: the frequencies of an image.
#include "zoneplate/imaging/signal/spectrum.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

Syntax make_syntax(SpectrumOptions& args) {
  Syntax syntax{
      .verb = "signal spectrum",
      .summary = "Compute the spectrum of an image",
      .operands = "IMAGE",
      .examples =
          "  zoneplate signal spectrum photo.jpg -o spectrum.png\n"
          "  zoneplate signal spectrum zone-plate:size=256 --side-by-side -o all.png\n"
          "  zoneplate signal spectrum photo.jpg --periodic --radial -o profile.svg\n"
          "  zoneplate signal spectrum sine:frequency=0.2,angle=30 --window hann --json\n",
      .notes =
          "The spectrum is that of Rec.709 luminance, in linear light (with --codes: of luma). In images\n"
          "frequency 0 is in the middle and one pixel is one bin: fx grows to the right, fy downwards, and the\n"
          "edges are half a cycle per pixel, the Nyquist frequency: the highest that the pixel grid represents.\n\n"
          "The discrete transform continues the image periodically. Where opposite borders differ, the\n"
          "continuation has discontinuities, which appear as a bright cross in the spectrum. Two remedies:\n"
          "  --window hann   fades the image out towards its borders: peaks widen, detail there is lost\n"
          "  --periodic      subtracts a smooth component that contains the discontinuities (Moisan 2011);\n"
          "                  nothing is faded\n\n"
          "Windows: none, hann, hamming, blackman, kaiser:beta=8, tukey:alpha=0.5\n\n" +
          image_notes()};
  const std::string group = "Options";
  syntax.options = {
      {"--phase", "", "Write the phase instead of the magnitude", group, true,
       [&](auto&) { args.shown = SpectrumView::Phase; }},
      {"--radial", "", "Print and plot (.svg or .png) the mean power over the distance from frequency 0", group, true,
       [&](auto&) { args.shown = SpectrumView::Radial; }},
      {"--side-by-side", "", "Write a figure of image, magnitude, phase and radial profile, with captions", group, true,
       [&](auto&) { args.shown = SpectrumView::Everything; }},
      {"--window", "NAME", "Window by which the image is multiplied before the transform; default none", group, true,
       [&](auto& text) { args.window = window_name(text); }},
      {"--periodic", "", "Transform the periodic component of the image (periodic plus smooth decomposition)", group,
       true, [&](auto&) { args.is_periodic = true; }},
      {"--range-db", "DB", "Decibels from black to the greatest magnitude, which is white; default 80", group, false,
       [&](auto& text) { args.range_db = parse_number(text, 1, 400); }},
      codes_option(args)};
  for (Option& option : image_options(args, "The image to write: a .png file, or - for stdout"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_signal_spectrum(std::span<const std::string> arguments) {
  SpectrumOptions args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  if (args.is_periodic && args.window != "none")
    throw Error(ErrorKind::Usage, "--window and --periodic cannot be combined: both remove the effect of the borders");
  args.shown == SpectrumView::Radial ? check_plot_name(args.output) : check_picture_name(args.output);
  run_subcommand(args, {input}, {}, [&](Delivery& out) { analyse_spectrum(input, args, out); });
}

}  // namespace zoneplate::cli
