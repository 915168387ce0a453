// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/signal/args.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/common_options.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate::cli {
namespace {

const std::string group = "Options";

void check_name(const std::string& path, std::initializer_list<std::string_view> endings) {
  if (path.empty() || path == "-" || path.starts_with("/dev/")) return;
  for (const std::string_view ending : endings)
    if (path.ends_with(ending)) return;
  throw Error(ErrorKind::Usage,
              fmt::format("--output: {}: expected a name that ends in {}, or -", path, fmt::join(endings, " or ")));
}

}  // namespace

std::vector<Option> output_options(SignalOptions& args, const std::string& output_meaning) {
  return {{"--output,-o", "FILE", output_meaning, group, true, [&](auto& text) { args.output = text; }},
          {"--json", "", "Print the result as one line of JSON", group, true, [&](auto&) { args.prints_json = true; }},
          {"--threads,-t", "N", "Maximum number of threads; 0, the default: the CPUs allowed by affinity and quota",
           group, false, [&](auto& text) { args.threads = parse_whole(text, 0, 1024); }}};
}

std::vector<Option> signal_options(SignalOptions& args, const std::string& output_meaning) {
  std::vector<Option> options = output_options(args, output_meaning);
  for (Option& option : limit_options(args.limits)) options.push_back(std::move(option));
  return options;
}

std::vector<Option> image_options(SignalOptions& args, const std::string& output_meaning) {
  std::vector<Option> options = signal_options(args, output_meaning);
  options.insert(options.begin(), layer_option(args.layer));
  return options;
}

void run_subcommand(const SignalOptions& args, const std::vector<std::string>& inputs,
                    const std::vector<std::string>& more_outputs, const std::function<void(Delivery&)>& work) {
  ConfinedRun run{.name = inputs.empty() ? "the run" : inputs.front(), .limits = args.limits, .readable = inputs};
  run.outputs = more_outputs;
  run.outputs.push_back(args.output);
  with_threads(args.threads, [&] { run_confined(run, work); });
}

Option codes_option(SignalOptions& args) {
  return {"--codes", "",    "Compute on the stored sRGB codes, as many programs do, instead of in linear light",
          group,     false, [&](auto&) { args.uses_codes = true; }};
}

Option border_option(Border& border, const std::string& rules) {
  return {"--border",
          "RULE",
          "Border rule, the values outside the image: " + rules + "; the first is the default",
          group,
          true,
          [&border, rules](auto& text) {
            border = parse_border(text);
            if (rules.find(text) == std::string::npos)
              throw Error(ErrorKind::Usage, fmt::format("'{}' cannot be used here; expected {}", text, rules));
          }};
}

const std::string& only_operand(const Syntax& syntax, const std::string& what) {
  if (syntax.found_operands.size() == 1) return syntax.found_operands[0];
  throw Error(ErrorKind::Usage, fmt::format("zoneplate {} requires {}; found {} operands", syntax.verb, what,
                                            syntax.found_operands.size()));
}

std::string image_notes() {
  std::string text =
      "IMAGE is a PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, BMP, TGA, HDR, EXR or PFM file (of an animation the\n"
      "first frame), - for stdin, or a generated pattern, NAME or NAME:PARAMETER=VALUE,...\n"
      "(for a file with such a name write ./NAME):\n";
  for (const PatternEntry& entry : patterns()) {
    std::string params;
    for (const Param& p : entry.params) params += fmt::format("{}{}={:g}", params.empty() ? "" : ",", p.name, p.value);
    text += fmt::format("  {:<14}{} [{}]\n", entry.name, entry.summary, params);
  }
  return text;
}

void check_picture_name(const std::string& path) { check_name(path, {".png"}); }
void check_result_name(const std::string& path) { check_name(path, {".png", ".pfm", ".exr"}); }
void check_plot_name(const std::string& path) { check_name(path, {".svg", ".png"}); }

std::vector<int> parse_whole_list(const std::string& text, int low, int high) {
  std::vector<int> numbers;
  for (const std::string& number : split_list(text)) numbers.push_back(parse_whole(number, low, high));
  return numbers;
}

}  // namespace zoneplate::cli
