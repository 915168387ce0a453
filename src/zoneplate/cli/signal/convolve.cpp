// SPDX-License-Identifier: Apache-2.0
// zoneplate signal convolve: convolution of an image or a list of numbers with a kernel, in space, by its spectrum, or
// both.
#include "zoneplate/imaging/signal/convolve.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

Plane<double> parse_values(const std::string& text) {
  Plane<double> values = parse_number_rows(text);
  if (values.height() != 1) throw Error(ErrorKind::Usage, "expected one row of numbers");
  return values;
}

Syntax make_syntax(ConvolutionOptions& args) {
  std::string notes =
      "Kernels: a name, as gaussian:sigma=2 (along rows and columns, its weights scaled to sum 1); numbers,\n"
      "as \"1/4 1/2 1/4\" (along rows) or \"-1 0 1; -2 0 2; -1 0 1\"; or a text file of numbers, row by row.\n"
      "Numbers are not normalized. The result of a kernel of sum 0 is signed: it is displayed around\n"
      "mid-grey, code 1/2 + value / 2.\n"
      "Names: box:width= tent:radius= gaussian:sigma=,extent= mitchell b-spline catmull-rom lanczos2 lanczos3\n"
      "lanczos:lobes= blackman-harris:radius= kaiser:radius=,beta=\n\n"
      "The convolution theorem: the spectrum of a convolution is the product of the spectra. For the\n"
      "discrete transform the convolution is circular, so the theorem holds directly for\n"
      "  wrap    periodic continuation, the signal that the discrete transform describes\n"
      "  zero    after zero padding by the radius of the kernel; otherwise the left border would bleed\n"
      "          into the right one (the zeros are black: alpha is continued from the border)\n"
      "and not directly for\n"
      "  clamp, reflect   the values outside the image depend on the position of the border, and a\n"
      "                   convolution is shift-invariant. The command therefore pads the image by the\n"
      "                   radius of the kernel before the transform and crops the result\n"
      "--via both computes the result in both ways and prints their greatest difference, and the error of\n"
      "the product of the spectra without padding.\n\n";
  Syntax syntax{.verb = "signal convolve",
                .summary = "Convolve an image, or a row of numbers, with a kernel",
                .operands = "IMAGE | --values NUMBERS",
                .examples =
                    "  zoneplate signal convolve photo.jpg --kernel gaussian:sigma=2 -o soft.png\n"
                    "  zoneplate signal convolve bricks --kernel \"-1 0 1; -2 0 2; -1 0 1\" -o edges.png\n"
                    "  zoneplate signal convolve zone-plate --kernel box:width=9 --via both --border wrap\n"
                    "  zoneplate signal convolve --values \"1 3 5 3 7 1 3 8 6 4\" --kernel \"1/4 1/2 1/4\"\n",
                .notes = notes + image_notes()};
  const std::string group = "Options";
  syntax.options = {
      {"--kernel", "KERNEL", "Kernel: a name, numbers or a file of numbers; default gaussian:sigma=2", group, true,
       [&](auto& text) {
         args.kernel_file = is_kernel_file(text) ? text : "";
         if (args.kernel_file.empty()) args.kernel = parse_kernel_choice(text);
       }},
      {"--values", "NUMBERS", "A row of numbers to convolve instead of an image; -o then writes a plot", group, true,
       [&](auto& text) { args.values = parse_values(text); }},
      {"--via", "WAY", "space (by the definition), frequency (product of the spectra) or both; default space", group,
       true,
       [&](auto& text) {
         constexpr Via ways[] = {Via::Space, Via::Frequency, Via::Both};
         args.via = ways[parse_choice(text, {"space", "frequency", "both"})];
       }},
      border_option(args.border, "clamp, reflect, wrap, zero"),
      {"--side-by-side", "", "Write a figure of input, kernel and result above their spectra, with captions", group,
       true, [&](auto&) { args.is_side_by_side = true; }},
      codes_option(args)};
  for (Option& option : image_options(args, result_meaning)) syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_signal_convolve(std::span<const std::string> arguments) {
  ConvolutionOptions args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (args.values && !syntax.found_operands.empty())
    throw Error(ErrorKind::Usage, "expected either an IMAGE or --values, not both");
  const std::string input = args.values ? "" : only_operand(syntax, "one IMAGE, or --values");
  args.values            ? check_plot_name(args.output)
  : args.is_side_by_side ? check_picture_name(args.output)
                         : check_result_name(args.output);
  run_subcommand(args, {args.values ? args.kernel_file : input, args.kernel_file}, {},
                 [&](Delivery& out) { convolve_signal(input, args, out); });
}

}  // namespace zoneplate::cli
