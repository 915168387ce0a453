// SPDX-License-Identifier: Apache-2.0
// zoneplate signal filter: removes the low, the high or a band of the frequencies of an image.
#include <fmt/format.h>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/signal/args.h"
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/imaging/signal/filter.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

using Pass = FrequencyFilter::Pass;

// The lowest cut-off frequency, and a highest one slightly above the corner of the spectrum.
constexpr double min_cut = 1e-6, max_cut = 1;

struct FilterArgs : FrequencyFilterOptions {
  int passes_given = 0;
};

void set_single(FilterArgs& args, Pass pass, const std::string& text) {
  const double f = parse_number(text, min_cut, max_cut);
  args.filter.pass = pass;
  args.filter.low = args.filter.high = f;
  ++args.passes_given;
}

void set_band(FilterArgs& args, Pass pass, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) throw Error(ErrorKind::Usage, fmt::format("'{}' is not a band LOW:HIGH", text));
  args.filter.low = parse_number(text.substr(0, colon), min_cut, max_cut);
  args.filter.high = parse_number(text.substr(colon + 1), min_cut, max_cut);
  if (!(args.filter.low < args.filter.high))
    throw Error(ErrorKind::Usage, fmt::format("'{}': the lower frequency comes first", text));
  args.filter.pass = pass;
  ++args.passes_given;
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

}  // namespace

void run_signal_filter(std::span<const std::string> arguments) {
  FilterArgs args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  const std::string& input = only_operand(syntax, "one IMAGE");
  if (args.passes_given != 1)
    throw Error(ErrorKind::Usage, "expected one of --low-pass, --high-pass, --band-pass and --band-stop");
  args.is_side_by_side ? check_picture_name(args.output) : check_result_name(args.output);
  run_subcommand(args, {input}, {}, [&](Delivery& out) { filter_frequencies(input, args, out); });
}

}  // namespace zoneplate::cli
