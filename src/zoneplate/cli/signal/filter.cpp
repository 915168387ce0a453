// SPDX-License-Identifier: Apache-2.0
// zoneplate signal filter: removes the low, the high or a band of the frequencies of an image.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/load.h"
#include "zoneplate/cli/signal/show.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/job/values.h"
#include "zoneplate/signal/fourier/frequency_filter.h"

namespace zoneplate::cli {
namespace {

using Pass = FrequencyFilter::Pass;

// The lowest cut-off frequency, and a highest one slightly above the corner of the spectrum.
constexpr double least_cut = 1e-6, greatest_cut = 1;

struct FilterArgs : SignalArgs {
  FrequencyFilter filter;
  std::string shape = "ideal";
  int passes_given = 0;
  Border border = Border::Reflect;
  bool is_side_by_side = false;

  /// True if the filter removes the mean: the result is differences, displayed around mid-grey.
  bool loses_mean() const { return response(filter, 0) < 0.5; }
};

void set_single(FilterArgs& args, Pass pass, const std::string& text) {
  const double f = parse_number(text, least_cut, greatest_cut);
  args.filter.pass = pass;
  args.filter.low = args.filter.high = f;
  ++args.passes_given;
}

void set_band(FilterArgs& args, Pass pass, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw Error(ErrorKind::Usage, fmt::format("'{}' is not a band LOW:HIGH", text));
  args.filter.low = parse_number(text.substr(0, colon), least_cut, greatest_cut);
  args.filter.high = parse_number(text.substr(colon + 1), least_cut, greatest_cut);
  if (!(args.filter.low < args.filter.high))
    throw Error(ErrorKind::Usage, fmt::format("'{}': the lower frequency comes first", text));
  args.filter.pass = pass;
  ++args.passes_given;
}

std::string name_of(const FilterArgs& args) {
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

Plot response_plot(const FilterArgs& args) {
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
Rgba8Image response_picture(const FilterArgs& args, int width, int height) {
  LinearImage image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double fx = static_cast<double>(x - width / 2) / width, fy = static_cast<double>(y - height / 2) / height;
      const float v = white * static_cast<float>(response(args.filter, std::sqrt(fx * fx + fy * fy)));
      image(x, y) = {v, v, v, 1};
    }
  return fitted(shown(image, true));
}

Rgba8Image picture_of(const FilterArgs& args, const LinearImage& result) {
  return args.loses_mean() ? shown_around_grey(result) : shown(result, args.uses_codes);
}

constexpr PlotSize plot_size{panel_px, panel_px * 3 / 4};

Figure figure_of(const std::string& input, const FilterArgs& args, const LinearImage& before,
                 const LinearImage& after) {
  const Spectrum was = fourier(luminance(before)), is = fourier(luminance(after));
  const MagnitudeScale scale{.peak = strongest_magnitude(was)};  // a common scale for comparison
  const std::string around = args.loses_mean() ? " The mean is removed: mid-grey is 0." : "";
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

Syntax make_syntax(FilterArgs& args) {
  Syntax syntax{
      .verb = "signal filter",
      .summary = "Filter an image in the frequency domain",
      .operands = "IMAGE",
      .examples =
          "  zoneplate signal filter photo.jpg --low-pass 0.1 -o soft.png\n"
          "  zoneplate signal filter photo.jpg --low-pass 0.1 --shape butterworth:order=4 --side-by-side -o why.png\n"
          "  zoneplate signal filter zone-plate --band-pass 0.1:0.2 -o ring.png\n"
          "  zoneplate signal filter scan.png --band-stop 0.24:0.26 --border wrap -o clean.png\n",
      .notes =
          "Frequencies are in cycles per pixel, and the filters are isotropic: 0.5 is the Nyquist frequency, 0.1\n"
          "a wavelength of 10 pixels. Each frequency is multiplied by the response, whose shape is one of\n"
          "  ideal                1 or 0; the discontinuity causes ringing, ripples at every edge\n"
          "  gaussian             smoothest, without ringing; one half at the cutoff\n"
          "  butterworth:order=N  between the two: flat, then steeper the greater N; one half at the cutoff\n"
          "An image without its mean (high-pass, band-pass) has negative values: it is displayed around\n"
          "mid-grey, code 1/2 + value / 2. Channels are filtered separately, alpha too, premultiplied and in\n"
          "linear light.\n\n"
          "The border rule reflect mirrors the image before the transform, so that opposite edges do not\n"
          "bleed into one another; wrap continues it periodically, and is exact for a tile. The other rules\n"
          "have no periodic continuation.\n\n" +
          image_notes()};
  const std::string group = "Filter";
  syntax.options = {
      {"--low-pass", "F", "Keep frequencies below F cycles per pixel: blur", group, true,
       [&](auto& text) { set_single(args, Pass::Low, text); }},
      {"--high-pass", "F", "Keep frequencies above F: edges and detail", group, true,
       [&](auto& text) { set_single(args, Pass::High, text); }},
      {"--band-pass", "LOW:HIGH", "Keep the frequencies between the two", group, true,
       [&](auto& text) { set_band(args, Pass::Band, text); }},
      {"--band-stop", "LOW:HIGH", "Remove the frequencies between the two", group, true,
       [&](auto& text) { set_band(args, Pass::Stop, text); }},
      {"--shape", "NAME", "ideal, gaussian or butterworth:order=4; default ideal", group, true,
       [&](auto& text) { args.filter.shape = parse_filter_shape(text), args.shape = text; }},
      border_option(args.border, "reflect, wrap"),
      {"--side-by-side", "", "Write a figure of image, spectrum and response, before and after, with captions",
       "Options", true, [&](auto&) { args.is_side_by_side = true; }},
      codes_option(args)};
  for (Option& option : image_options(args, result_meaning)) syntax.options.push_back(std::move(option));
  return syntax;
}

void tell_result(const std::string& input, const FilterArgs& args, const LinearImage& before, const LinearImage& after,
                 Delivery& out) {
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

void run_signal_filter(std::span<const std::string> arguments) {
  FilterArgs args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  if (args.passes_given != 1)
    throw Error(ErrorKind::Usage, "expected one of --low-pass, --high-pass, --band-pass and --band-stop");
  args.is_side_by_side ? check_picture_name(args.output) : check_result_name(args.output);
  run_subcommand(args, {input}, {}, [&](Delivery& out) {
    Signal signal = load_as_stored(input, signal_choice(args, true), out);
    if (args.is_side_by_side) signal = in_rec709(std::move(signal));
    const LinearImage& before = signal.image;
    const LinearImage after = filtered(before, args.filter, args.border);
    if (args.is_side_by_side && !args.output.empty())
      out.save_figure(args.output, figure_of(input, args, before, after), plot_size);
    else if (!args.output.empty() && args.loses_mean())
      save_signal(args.output, {after, signal.meaning, signal.origin}, out, [&] { return picture_of(args, after); });
    else if (!args.output.empty())
      save_signal(args.output, {after, signal.meaning, signal.origin}, out);
    tell_result(input, args, before, after, out);
  });
}

}  // namespace zoneplate::cli
