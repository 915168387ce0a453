// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/filter.h"

#include <fmt/format.h>
#include <cmath>
#include <numbers>

#include "zoneplate/base/utf8.h"
#include "zoneplate/imaging/signal/load.h"
#include "zoneplate/imaging/signal/show.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate {
namespace {

using Pass = FrequencyFilter::Pass;

/// True if the filter removes the mean: the result is differences, displayed around mid-grey.
bool loses_mean(const FrequencyFilterOptions& args) { return response(args.filter, 0) < 0.5; }

std::string name_of(const FrequencyFilterOptions& args) {
  const FrequencyFilter& f = args.filter;
  switch (f.pass) {
    case Pass::Low:
      return fmt::format("low-pass {:g}, {}", f.high, args.shape);
    case Pass::High:
      return fmt::format("high-pass {:g}, {}", f.low, args.shape);
    case Pass::Band:
      return fmt::format("band-pass {:g} to {:g}, {}", f.low, f.high, args.shape);
    case Pass::Stop:
      break;
  }
  return fmt::format("band-stop {:g} to {:g}, {}", f.low, f.high, args.shape);
}

double variance(const Plane<float>& plane) {
  double sum = 0, squares = 0;
  for (const float v : plane.values()) sum += static_cast<double>(v);
  const double mean = sum / static_cast<double>(plane.values().size());
  for (const float v : plane.values()) squares += (static_cast<double>(v) - mean) * (static_cast<double>(v) - mean);
  return squares / static_cast<double>(plane.values().size());
}

Plot response_plot(const FrequencyFilterOptions& args) {
  Curve curve{"response", {}, Curve::Mark::Line};
  constexpr int steps = 700;
  for (int i = 0; i <= steps; ++i) {
    const double f = std::numbers::sqrt2 / 2 * i / steps;
    curve.points.emplace_back(f, response(args.filter, f));
  }
  return {.title = "Response of the filter",
          .x = {"frequency (cycles per pixel)", 0, std::numbers::sqrt2 / 2},
          .y = {"factor", 0, 1.1},
          .curves = {curve, {"Nyquist frequency", {{0.5, 0}, {0.5, 1.1}}, Curve::Mark::Dashed, Curve::grey}}};
}

// Slightly darker than the background, so that a figure outlines the image.
constexpr float white = 254.0f / 255;

/// The response as multiplied with the transform: a factor for every bin, black is 0 and white is 1.
Rgba8Image response_picture(const FrequencyFilterOptions& args, int width, int height) {
  LinearImage image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double fx = static_cast<double>(x - width / 2) / width, fy = static_cast<double>(y - height / 2) / height;
      const float v = white * static_cast<float>(response(args.filter, std::sqrt(fx * fx + fy * fy)));
      image(x, y) = {v, v, v, 1};
    }
  return fitted(shown(image, true));
}

Rgba8Image picture_of(const FrequencyFilterOptions& args, const LinearImage& result) {
  return loses_mean(args) ? shown_around_grey(result) : shown(result, args.uses_codes);
}

constexpr PlotSize plot_size{panel_px, panel_px * 3 / 4};

Figure figure_of(const std::string& input, const FrequencyFilterOptions& args, const LinearImage& before,
                 const LinearImage& after) {
  const Spectrum was = fourier(luminance(before)), is = fourier(luminance(after));
  const MagnitudeScale scale{.peak = strongest_magnitude(was)};  // a common scale for comparison
  const std::string around = loses_mean(args) ? " The mean is removed: mid-grey is 0." : "";
  const std::string shape =
      before.width() == before.height() ? "" : " The filter is isotropic; the plot has the image's aspect ratio.";
  return {
      .title = fmt::format("{}: {}", title_of(input), name_of(args)),
      .rows = {{{fitted(shown(before, args.uses_codes)), "Image\nThe input."},
                {magnitude_panel(was, scale), fmt::format("Its spectrum\nFrequency 0 in the middle, ½ cycle per pixel "
                                                          "at the edges; {:g} dB from black to the maximum.",
                                                          scale.range_db)},
                {response_picture(args, before.width(), before.height()),
                 "Response\nThe factor of each frequency: white 1, black 0." + shape}},
               {{fitted(picture_of(args, after)), "Filtered image\nThe inverse transform of the product." + around},
                {magnitude_panel(is, scale), "Its spectrum\nThe product of the two above, on the same scale."},
                {{}, "", response_plot(args)}}},
      .text = {}};
}

void tell_result(const std::string& input, const FrequencyFilterOptions& args, const LinearImage& before,
                 const LinearImage& after, Delivery& out) {
  const double was = variance(luminance(before)), is = variance(luminance(after));
  const double kept = was > 0 ? is / was : 1;
  const bool has_low = args.filter.pass != Pass::Low, has_high = args.filter.pass != Pass::High;
  print_result(
      args,
      fmt::format("{}, {} × {}: {}, border {}\n  {:.2f} % of the variance of the luminance remains\n", printable(input),
                  before.width(), before.height(), name_of(args), name_of(args.border), 100 * kept),
      {{"input", input},
       {"output", args.output},
       {"width", before.width()},
       {"height", before.height()},
       {"filter", name_of(args)},
       {"shape", args.shape},
       {"low", has_low ? Json(args.filter.low) : Json()},
       {"high", has_high ? Json(args.filter.high) : Json()},
       {"border", name_of(args.border)},
       {"variance_before", was},
       {"variance_after", is}},
      out);
}

}  // namespace

void filter_frequencies(const std::string& input, const FrequencyFilterOptions& args, Delivery& out) {
  Signal signal = load_as_stored(input, signal_choice(args, true), out);
  if (args.is_side_by_side) signal = in_rec709(std::move(signal));
  const LinearImage& before = signal.image;
  const LinearImage after = filtered(before, args.filter, args.border);
  if (args.is_side_by_side && !args.output.empty())
    out.save_figure(args.output, figure_of(input, args, before, after), plot_size);
  else if (!args.output.empty() && loses_mean(args))
    save_signal(args.output, {after, signal.meaning, signal.origin}, out, [&] { return picture_of(args, after); });
  else if (!args.output.empty())
    save_signal(args.output, {after, signal.meaning, signal.origin}, out);
  tell_result(input, args, before, after, out);
}

}  // namespace zoneplate
