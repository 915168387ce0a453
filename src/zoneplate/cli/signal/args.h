// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/cli/args.h"
#include "zoneplate/cli/process/confined.h"
#include "zoneplate/cli/signal/load.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/plot.h"
#include "zoneplate/signal/border.h"

namespace zoneplate::cli {

/// The common options of the subcommands of `signal` and `texture`.
struct SignalArgs {
  std::string report = "zoneplate-signal";  ///< "format" of the JSON
  std::string output;                       ///< a file, "-" for stdout, or empty: numbers only
  std::string layer;                        ///< of an image that is an EXR
  bool prints_json = false;
  bool uses_codes = false;  ///< operates on display codes instead of linear light
  int threads = 0;
  ReadingLimits limits;
};

/// The options --output, --json and --threads; `output_meaning` is the help text of --output.
std::vector<Option> output_options(SignalArgs& args, const std::string& output_meaning);

/// The same and those of limits, for subcommands that read files.
std::vector<Option> signal_options(SignalArgs& args, const std::string& output_meaning);

/// The same and --layer, for subcommands that read an image.
std::vector<Option> image_options(SignalArgs& args, const std::string& output_meaning);

/// How the image of a subcommand with these options is loaded. A result of the same size as the image has the overscan
/// of an EXR too, where it is written to one.
SignalChoice signal_choice(const SignalArgs& args, bool keeps_size = false);

/// Runs the work of a subcommand in a confined process (process/confined.h), with the threads of the arguments. It
/// reads `inputs`, of which messages about limits name the first, and writes `args.output` and `more_outputs`.
void run_subcommand(const SignalArgs& args, const std::vector<std::string>& inputs,
                    const std::vector<std::string>& more_outputs, const std::function<void(Delivery&)>& work);

/// The option --codes, for subcommands that change images.
Option codes_option(SignalArgs& args);

/// The option --border with the supported rules, the default first: "clamp, reflect".
Option border_option(Border& border, const std::string& rules);

/// The single operand of a subcommand.
///
/// Errors    ErrorKind::Usage for none or more than one; the message names `what`.
const std::string& only_operand(const Syntax& syntax, const std::string& what);

/// The section of the help about IMAGE and the patterns.
std::string image_notes();

/// Throws for an output whose name does not end in .png (or, for a plot, .svg; for a result, .pfm or .exr) and is not
/// "-".
void check_picture_name(const std::string& path);
void check_result_name(const std::string& path);
void check_plot_name(const std::string& path);

void save_picture(const std::string& path, const Rgba8Image& picture, Delivery& out, const ColorProfile& profile = {});

/// Writes a result: to .pfm and .exr the values as premultiplied floats, neither clamped nor shifted; to any other name
/// the display image `picture()`.
void save_result(const std::string& path, const LinearImage& values, const std::function<Rgba8Image()>& picture,
                 Delivery& out);

/// Writes a result with the profile of its input, as far as the format of the output states it: to .png codes of its
/// space, to .exr light of its chromaticities, else sRGB codes or light of Rec.709 primaries, with a warning; codes as
/// they are.
/// What is made of an EXR keeps in an EXR what else that file has (save_light), with a warning of what it lacks.
/// `picture`: the image of a .png, in sRGB, if it does not show the colours themselves.
void save_signal(const std::string& path, const Signal& values, Delivery& out,
                 const std::function<Rgba8Image()>& picture = {});

/// The outputs of save_result, for the help.
inline constexpr const char* result_meaning =
    "The image to write: a .png file, or - for stdout; .pfm and .exr hold the values themselves, in floats";

/// Prints the results to stdout, as text or as one line of JSON with "format" and "version" before the members of
/// `json`. Where the image is written to stdout, JSON goes to stderr instead and text is omitted.
void print_result(const SignalArgs& args, const std::string& text, const Json::Object& json, Delivery& out);

/// Parses "1,3,5": integers in [low, high], at least one.
std::vector<int> parse_whole_list(const std::string& text, int low, int high);

}  // namespace zoneplate::cli
