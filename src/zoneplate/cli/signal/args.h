// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/cli/args.h"
#include "zoneplate/cli/confined.h"
#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/signal/border.h"

namespace zoneplate::cli {

/// The options --output, --json and --threads; `output_meaning` is the help text of --output.
std::vector<Option> output_options(SignalOptions& args, const std::string& output_meaning);

/// The same and those of limits, for subcommands that read files.
std::vector<Option> signal_options(SignalOptions& args, const std::string& output_meaning);

/// The same and --layer, for subcommands that read an image.
std::vector<Option> image_options(SignalOptions& args, const std::string& output_meaning);

/// Runs the work of a subcommand in a confined process (cli/confined.h), with the threads of the arguments. It
/// reads `inputs`, of which messages about limits name the first, and writes `args.output` and `more_outputs`.
void run_subcommand(const SignalOptions& args, const std::vector<std::string>& inputs,
                    const std::vector<std::string>& more_outputs, const std::function<void(Delivery&)>& work);

/// The option --codes, for subcommands that change images.
Option codes_option(SignalOptions& args);

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

/// The outputs of save_result, for the help.
inline constexpr const char* result_meaning =
    "The image to write: a .png file, or - for stdout; .pfm and .exr hold the values themselves, in floats";

/// Parses "1,3,5": integers in [low, high], at least one.
std::vector<int> parse_whole_list(const std::string& text, int low, int high);

}  // namespace zoneplate::cli
