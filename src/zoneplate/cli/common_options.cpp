// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/common_options.h"

#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/options.h"

namespace zoneplate::cli {
namespace {

constexpr int max_side = 1 << 20;

/// The rectangle of "x,y,width,height".
metrics::IgnoredRegions::Rectangle parse_rectangle(const std::string& text) {
  std::vector<std::string> parts{""};
  for (const char c : text) c == ',' ? static_cast<void>(parts.emplace_back()) : parts.back().push_back(c);
  if (parts.size() != 4) throw Error(ErrorKind::Usage, text + ": expected x,y,width,height or an image file");
  return {parse_whole(parts[0], 0, max_side), parse_whole(parts[1], 0, max_side), parse_whole(parts[2], 1, max_side),
          parse_whole(parts[3], 1, max_side)};
}

void add(const std::string& text, IgnoredInputs& args) {
  std::error_code ignored;
  if (std::filesystem::exists(text, ignored))
    args.masks.push_back(text);
  else if (text.find_first_not_of("0123456789,") == std::string::npos)
    args.rectangles.push_back(parse_rectangle(text));
  else
    throw Error(ErrorKind::Input, text + ": no such file, and not x,y,width,height");
  args.texts.push_back(text);
}

}  // namespace

std::vector<Option> limit_options(LoadLimits& load, double& seconds, bool& is_sandboxed, const std::string& group,
                                  const std::string& subject) {
  std::vector<Option> options = reading_options(load, group, subject);
  options.push_back({"--max-seconds", "S", "Time limit of " + subject + ", including reading; default: no limit", group,
                     false, number(0.001, 1e9, [&](double x) { seconds = x; })});
  options.push_back({"--sandbox", "", "Read and compute in a sandboxed process: the default", group, false,
                     [&](auto&) { is_sandboxed = true; }});
  options.push_back({"--no-sandbox", "",
                     "Read and compute without a sandbox, with all rights of the user: for trusted files", group, false,
                     [&](auto&) { is_sandboxed = false; }});
  return options;
}

Option layer_option(std::string& layer) {
  return {"--layer",
          "NAME",
          "Layer or part of an EXR, such as beauty, ViewLayer.Combined or Z; default: the colours that viewers show",
          "Options",
          false,
          [&layer](auto& text) {
            if (text.empty()) throw Error(ErrorKind::Usage, "is empty, expected the name of a layer");
            layer = text;
          }};
}

Option ignore_option(IgnoredInputs& args, const std::string& group) {
  return {
      "--ignore",
      "REGION",
      "Do not compare this region: x,y,width,height in pixels from the top left, or an image whose pixels above half "
      "of white are ignored; may be repeated",
      group,
      true,
      [&](auto& text) { add(text, args); }};
}

}  // namespace zoneplate::cli
