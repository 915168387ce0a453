// SPDX-License-Identifier: Apache-2.0
// zoneplate signal resample: resamples an image on another grid.
#include <fmt/format.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/load.h"
#include "zoneplate/cli/signal/reduce.h"
#include "zoneplate/cli/signal/show.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/job/values.h"

namespace zoneplate::cli {
namespace {

constexpr int greatest_side = 32768;

struct ResampleArgs : SignalArgs {
  std::string size, kernel = "lanczos3";
  Border border = Border::Clamp;
  bool is_side_by_side = false;
};

// Parses "640x480", "640,480", "0.5" or "50%".
int2 size_from(const std::string& text, int width, int height) {
  if (text.find_first_of("x,") != std::string::npos) return parse_size(text, greatest_side);
  const bool is_percent = text.ends_with('%');
  const double factor = parse_number(text.substr(0, text.size() - is_percent), 0, 1e6) / (is_percent ? 100 : 1);
  const auto scaled = [&](int n) { return static_cast<int>(std::clamp(std::floor(n * factor + 0.5), 1.0, 1e9)); };
  const int2 size{scaled(width), scaled(height)};
  if (factor <= 0 || size.x > greatest_side || size.y > greatest_side)
    throw Error(ErrorKind::Usage, fmt::format("--size: {} gives {} × {}, expected 1 to {} pixels a side", text, size.x,
                                              size.y, greatest_side));
  return size;
}

Rgba8Image figure_of(const std::string& input, const ResampleArgs& args, const LinearImage& image,
                     const LinearImage& result) {
  const LinearImage nearest = resampled(image, result.width(), result.height(), "nearest", args.border);
  const auto panel = [&](const LinearImage& of, const std::string& caption) {
    return Panel{fitted(shown(of, args.uses_codes)), caption};
  };
  return compose(
      {.title = fmt::format("{}: {} × {} to {} × {}", title_of(input), image.width(), image.height(), result.width(),
                            result.height()),
       .rows = {{panel(image, "Image\nThe input."),
                 panel(nearest, "nearest\nThe input pixel that contains each new centre."),
                 panel(result, args.kernel + "\nEach new pixel is a weighted mean of the pixels around its centre.")}},
       .text = {}});
}

Syntax make_syntax(ResampleArgs& args) {
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
  ResampleArgs args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  if (args.size.empty()) throw Error(ErrorKind::Usage, "--size is missing: the new size, such as 640x480 or 50%");
  if (args.output.empty()) throw Error(ErrorKind::Usage, "--output is missing: the image file to write");
  args.is_side_by_side ? check_picture_name(args.output) : check_result_name(args.output);
  run_subcommand(args, {input}, {}, [&](Delivery& out) {
    Signal signal = load_as_stored(input, signal_choice(args, true), out);
    if (args.is_side_by_side) signal = in_rec709(std::move(signal));
    const int2 seen = displayed_size(signal), asked = size_from(args.size, seen.x, seen.y);
    if (asked != seen) crop_to_display(signal);
    const LinearImage& image = signal.image;
    const int2 size = asked != seen ? asked : int2{image.width(), image.height()};
    const Signal result{resampled(image, size.x, size.y, args.kernel, args.border), signal.meaning, signal.origin};
    if (args.is_side_by_side)
      save_picture(args.output, figure_of(input, args, image, result.image), out);
    else
      save_signal(args.output, result, out);
    print_result(args,
                 fmt::format("{}, {} × {} to {} × {} by {}, border {}\n", printable(input), image.width(),
                             image.height(), size.x, size.y, args.kernel, name_of(args.border)),
                 {{"input", input},
                  {"output", args.output},
                  {"width", size.x},
                  {"height", size.y},
                  {"from_width", image.width()},
                  {"from_height", image.height()},
                  {"kernel", args.kernel},
                  {"border", name_of(args.border)}},
                 out);
  });
}

}  // namespace zoneplate::cli
