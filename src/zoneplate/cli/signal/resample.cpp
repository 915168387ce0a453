// SPDX-License-Identifier: Apache-2.0
// zoneplate signal resample: resamples an image on another grid.
#include "zoneplate/imaging/signal/resample.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/imaging/signal/reduce.h"

namespace zoneplate::cli {
namespace {

Syntax make_syntax(ResamplingOptions& args) {
  Syntax syntax{
      .verb = "signal resample",
      .summary = "Resample an image to another size",
      .operands = "IMAGE",
      .examples =
          "  zoneplate signal resample photo.jpg --size 640x480 -o small.png\n"
          "  zoneplate signal resample photo.jpg --size 50% --kernel mitchell -o half.png\n"
          "  zoneplate signal resample icon.png --size 8 --kernel catmull-rom -o large.png\n"
          "  zoneplate signal resample bricks --size 0.27 --side-by-side -o why.png\n",
      .notes =
          "The kernel interpolates between pixels; for downsampling it is stretched by the scale factor, so that\n"
          "it also removes frequencies above the new Nyquist frequency. Pixel centres are aligned: there is no\n"
          "shift by half a pixel, and constants and linear ramps are reproduced. Colours are averaged in linear\n"
          "light, premultiplied; --codes averages sRGB codes, which darkens fine detail.\n\n"
          "Besides the kernels of zoneplate signal convolve there are nearest (no filter) and ideal (exactly the\n"
          "frequencies that both grids represent; the image is continued periodically).\n"
          "Negative lobes (lanczos, catmull-rom, mitchell, kaiser) overshoot at edges; values outside 0 to 1 are\n"
          "clamped in a .png, and kept in a .pfm or .exr.\n\n"
          "Where the kernel extends outside the image, --border cut divides by the sum of the weights inside, as\n"
          "Pillow does; clamp, the default, repeats the border's pixels; zero uses black, with alpha continued\n"
          "from the border. A pixel at a discontinuity of a kernel (box: halfway between two new centres)\n"
          "has half its weight on both sides; Pillow assigns it to one. On a tie nearest uses the pixel to the\n"
          "right or below, as Pillow does.\n\n" +
          image_notes()};
  const std::string group = "Options";
  syntax.options = {
      {"--size", "SIZE", "WIDTHxHEIGHT, or a factor such as 0.5, 2 or 50%", group, true,
       [&](auto& text) { args.size = text; }},
      {"--kernel", "NAME", "lanczos3 (default), mitchell, box, tent, gaussian:sigma=0.5, ..., nearest, ideal", group,
       true, [&](auto& text) { check_reduction(text), args.kernel = text; }},
      border_option(args.border, "clamp, reflect, wrap, zero, cut"),
      {"--side-by-side", "", "Write a figure of the input, the nearest pixels and the result, with captions", group,
       true, [&](auto&) { args.is_side_by_side = true; }},
      codes_option(args)};
  for (Option& option : image_options(args, result_meaning)) syntax.options.push_back(std::move(option));
  return syntax;
}

}  // namespace

void run_signal_resample(std::span<const std::string> arguments) {
  ResamplingOptions args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  if (args.size.empty()) throw Error(ErrorKind::Usage, "--size is missing: the new size, such as 640x480 or 50%");
  if (args.output.empty()) throw Error(ErrorKind::Usage, "--output is missing: the image file to write");
  args.is_side_by_side ? check_picture_name(args.output) : check_result_name(args.output);
  run_subcommand(args, {input}, {}, [&](Delivery& out) { resample_image(input, args, out); });
}

}  // namespace zoneplate::cli
