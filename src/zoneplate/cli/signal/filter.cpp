// zoneplate signal filter: an image without the low, the high or a band of its frequencies.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/load.h"
#include "zoneplate/cli/signal/show.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/signal/fourier/frequency_filter.h"

namespace zoneplate::cli {
namespace {

using Pass = FrequencyFilter::Pass;

// The least frequency that a filter may cut at, and a little more than the corner of the spectrum.
constexpr double least_cut = 1e-6, greatest_cut = 1;

struct FilterArgs : SignalArgs {
  FrequencyFilter filter;
  std::string shape = "ideal";
  int passes_given = 0;
  Border border = Border::Reflect;
  bool is_side_by_side = false;

  /// The mean is gone: the picture is of differences, and shown around mid-grey.
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

// A little less than paper, so that a figure draws the picture's outline.
constexpr float white = 254.0f / 255;

/// The response as the transform sees it: a factor for every bin, black 0 and white 1.
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

Rgba8Image figure_of(const std::string& input, const FilterArgs& args, const LinearImage& before,
                     const LinearImage& after) {
  const Spectrum was = fourier(luminance(before)), is = fourier(luminance(after));
  const MagnitudeScale scale{.peak = strongest_magnitude(was)};  // one for both, so that they can be compared
  const Rgba8Image plot = plot_picture(response_plot(args), {panel_px, panel_px * 3 / 4});
  const std::string around = args.loses_mean() ? " The mean is gone: mid-grey is 0." : "";
  const std::string shape =
      before.width() == before.height() ? "" : " In frequency it is round; the picture has the image's shape.";
  const Figure figure{
      .title = fmt::format("{}: {}", title_of(input), name_of(args)),
      .rows = {{{fitted(shown(before, args.uses_codes)), "Image\nAs it came."},
                {magnitude_panel(was, scale), fmt::format("Its spectrum\nFrequency 0 in the middle, ½ cycle per pixel "
                                                          "at the edges; {:g} dB from black to the palest.",
                                                          scale.range_db)},
                {response_picture(args, before.width(), before.height()),
                 "Response\nWhat every frequency is multiplied with: white 1, black 0." + shape}},
               {{fitted(picture_of(args, after)), "Filtered image\nThe waves that are left, added up again." + around},
                {magnitude_panel(is, scale), "Its spectrum\nThe product of the two above, on the same scale."},
                {plot, ""}}},
      .text = {}};
  return compose(figure);
}

Syntax make_syntax(FilterArgs& args) {
  Syntax syntax{
      .verb = "signal filter",
      .summary = "Take frequencies out of an image",
      .operands = "IMAGE",
      .examples =
          "  zoneplate signal filter photo.jpg --low-pass 0.1 -o soft.png\n"
          "  zoneplate signal filter photo.jpg --low-pass 0.1 --shape butterworth:order=4 --side-by-side -o why.png\n"
          "  zoneplate signal filter zone-plate --band-pass 0.1:0.2 -o ring.png\n"
          "  zoneplate signal filter scan.png --band-stop 0.24:0.26 --border wrap -o clean.png\n",
      .notes =
          "Frequencies are in cycles per pixel, in every direction alike: 0.5 is the Nyquist frequency, 0.1 a\n"
          "wave of 10 pixels. The filter multiplies each frequency with its response; how it falls is the shape:\n"
          "  ideal                all or nothing. A knife in frequency rings in space: ripples at every edge\n"
          "  gaussian             softest, without any ripple; one half at the cut\n"
          "  butterworth:order=N  between the two: flat, then steeper the greater N; one half at the cut\n"
          "An image whose mean is taken away (high-pass, band-pass) holds negative values: it is shown around\n"
          "mid-grey, code 1/2 + value / 2. Each channel is filtered alone, alpha too, premultiplied and in\n"
          "linear light.\n\n"
          "The border rule reflect mirrors the image before it is transformed, so that opposite edges do not\n"
          "bleed into one another; wrap takes it as a tile, and is exact for one. The other rules cannot be\n"
          "continued without end.\n\n" +
          image_notes()};
  const std::string group = "Filter";
  syntax.options = {
      {"--low-pass", "F", "Keep what is coarser than F cycles per pixel: blur", group, true,
       [&](auto& text) { set_single(args, Pass::Low, text); }},
      {"--high-pass", "F", "Keep what is finer: edges and detail", group, true,
       [&](auto& text) { set_single(args, Pass::High, text); }},
      {"--band-pass", "LOW:HIGH", "Keep what is between the two", group, true,
       [&](auto& text) { set_band(args, Pass::Band, text); }},
      {"--band-stop", "LOW:HIGH", "Take out what is between the two", group, true,
       [&](auto& text) { set_band(args, Pass::Stop, text); }},
      {"--shape", "NAME", "ideal, gaussian or butterworth:order=4; default ideal", group, true,
       [&](auto& text) { args.filter.shape = parse_filter_shape(text), args.shape = text; }},
      border_option(args.border, "reflect, wrap"),
      {"--side-by-side", "", "The picture shows image, spectrum and response, before and after, with captions",
       "Options", true, [&](auto&) { args.is_side_by_side = true; }},
      codes_option(args)};
  for (Option& option : signal_options(args, result_meaning)) syntax.options.push_back(std::move(option));
  return syntax;
}

void tell_result(const std::string& input, const FilterArgs& args, const LinearImage& before,
                 const LinearImage& after) {
  const double was = variance(luminance(before)), is = variance(luminance(after));
  const double kept = was > 0 ? is / was : 1;
  const bool has_low = args.filter.pass != Pass::Low, has_high = args.filter.pass != Pass::High;
  tell(args,
       fmt::format("{}, {} × {}: {}, border {}\n  {:.2f} % of the luminance's variance is left\n", input,
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
        {"variance_after", is}});
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
  with_threads(args.threads, [&] {
    const LinearImage before = load_signal(input, args.uses_codes);
    const LinearImage after = filtered(before, args.filter, args.border);
    if (!args.output.empty())
      save_result(args.output, after, [&] {
        return args.is_side_by_side ? figure_of(input, args, before, after) : picture_of(args, after);
      });
    tell_result(input, args, before, after);
  });
}

}  // namespace zoneplate::cli
