// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/resample.h"

#include <fmt/format.h>
#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/imaging/signal/load.h"
#include "zoneplate/imaging/signal/reduce.h"
#include "zoneplate/imaging/signal/show.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/report/figure.h"

namespace zoneplate {
namespace {

constexpr int max_side = 32768;

// Parses "640x480", "640,480", "0.5" or "50%".
int2 size_from(const std::string& text, int width, int height) {
  if (text.find_first_of("x,") != std::string::npos) return parse_size(text, max_side);
  const bool is_percent = text.ends_with('%');
  const double factor = parse_number(text.substr(0, text.size() - is_percent), 0, 1e6) / (is_percent ? 100 : 1);
  const auto scaled = [&](int n) { return static_cast<int>(std::clamp(std::floor(n * factor + 0.5), 1.0, 1e9)); };
  const int2 size{scaled(width), scaled(height)};
  if (factor <= 0 || size.x > max_side || size.y > max_side)
    throw Error(ErrorKind::Usage, fmt::format("--size: {} gives {} × {}, expected 1 to {} pixels a side", text, size.x,
                                              size.y, max_side));
  return size;
}

Rgba8Image figure_of(const std::string& input, const ResamplingOptions& args, const LinearImage& image,
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

}  // namespace

void resample_image(const std::string& input, const ResamplingOptions& args, Delivery& out) {
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
               fmt::format("{}, {} × {} to {} × {} by {}, border {}\n", printable(input), image.width(), image.height(),
                           size.x, size.y, args.kernel, name_of(args.border)),
               {{"input", input},
                {"output", args.output},
                {"width", size.x},
                {"height", size.y},
                {"from_width", image.width()},
                {"from_height", image.height()},
                {"kernel", args.kernel},
                {"border", name_of(args.border)}},
               out);
}

}  // namespace zoneplate
