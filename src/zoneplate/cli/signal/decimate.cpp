// SPDX-License-Identifier: Apache-2.0
// zoneplate signal decimate: every n-th pixel, with and without a filter before.
#include "zoneplate/imaging/signal/decimate.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate::cli {
namespace {

Syntax make_syntax(DecimateOptions& args) {
  Syntax syntax{
      .verb = "signal decimate",
      .summary = "Downsample an image twice: by dropping pixels, and by filtering first",
      .operands = "IMAGE",
      .examples =
          "  zoneplate signal decimate zone-plate --by 2 -o moire.png\n"
          "  zoneplate signal decimate photo.jpg --by 4 --kernel mitchell -o compare.png --filtered small.png\n"
          "  zoneplate signal decimate zone-plate:size=370 --by 3.7 --all-kernels\n",
      .notes =
          "A grid of every n-th pixel represents frequencies up to 1/(2n) cycle per pixel. When pixels are\n"
          "dropped, higher frequencies do not vanish: they alias to lower ones, where no later filter can\n"
          "separate them from the signal. A low-pass filter has to remove them before. The attenuation of a\n"
          "kernel is printed in decibels: -20 dB is a tenth of the amplitude. The theoretical figures are those\n"
          "of an image with a flat spectrum.\n\n" +
          image_notes()};
  const std::string group = "Options";
  syntax.options = {
      {"--by", "N", "Downsampling factor, from 1 to 64, integer or not; default 2", group, true,
       [&](auto& text) { args.by = parse_number(text, 1, 64); }},
      {"--kernel", "NAME", "Kernel of the filter; default lanczos3", group, true,
       [&](auto& text) { args.kernel = make_kernel(text).name; }},
      {"--all-kernels", "", "Print the figures of every kernel", group, true, [&](auto&) { args.compares_all = true; }},
      {"--naive", "FILE", "Write the unfiltered image alone: .png, or the values as .pfm or .exr", group, false,
       [&](auto& text) { args.naive_path = text; }},
      {"--filtered", "FILE", "Write the filtered image alone: .png, or the values as .pfm or .exr", group, false,
       [&](auto& text) { args.filtered_path = text; }},
      codes_option(args)};
  for (Option& option :
       image_options(args, "Write a figure of both results with their spectra and captions: a .png file, or -"))
    syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_signal_decimate(std::span<const std::string> arguments) {
  DecimateOptions args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  check_picture_name(args.output);
  for (const std::string& path : {args.naive_path, args.filtered_path}) check_result_name(path);
  run_subcommand(args, {input}, {args.naive_path, args.filtered_path},
                 [&](Delivery& out) { decimate_image(input, args, out); });
}

}  // namespace zoneplate::cli
