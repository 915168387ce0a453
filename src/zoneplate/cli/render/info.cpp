// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/common_options.h"
#include "zoneplate/cli/confined.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/options.h"
#include "zoneplate/process/item_process.h"
#include "zoneplate/process/packed.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/report_version.h"
#include "zoneplate/report/scene_contents.h"

namespace zoneplate::cli {
namespace {

Json info_json(const std::string& input, const Scene& scene) {
  Json::Object out{{"format", "zoneplate-info"}, {"version", report_version}, {"input", input}};
  for (auto& member : scene_contents(scene)) out.push_back(std::move(member));
  return out;
}

// Serializes the text to be printed, and the warnings.
std::vector<std::uint8_t> packed_info(const std::string& input, const Scene& scene, bool prints_json) {
  Packer out;
  out.text(prints_json ? info_json(input, scene).text() + '\n' : printable(input) + '\n' + scene_contents_text(scene));
  out.value(std::uint64_t{scene.warnings.size()});
  for (const std::string& warning : scene.warnings) out.text(warning);
  return std::move(out).bytes();
}

}  // namespace

void run_info(std::span<const std::string> arguments) {
  bool prints_json = false;
  LoadOptions options;
  double max_seconds = std::numeric_limits<double>::infinity();
  bool is_sandboxed = true;
  Syntax syntax{.verb = "info",
                .summary = "Print the contents of a model: meshes, materials, textures, lights, cameras, bounds",
                .operands = "IN",
                .examples = "  zoneplate info chair.glb\n  zoneplate info chair.glb --json\n"};
  syntax.options = {{"--json", "", "Print one line of JSON", "Options", true, [&](auto&) { prints_json = true; }},
                    {"--format", "NAME", "Read IN as this format, for example stl; required if IN is -", "Options",
                     false, [&](auto& text) { options.format = text; }},
                    allow_path_option(options.limits, "Options")};
  for (Option& option : limit_options(options.limits, max_seconds, is_sandboxed, "Options", "the run"))
    syntax.options.push_back(std::move(option));
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.size() != 1)
    throw Error(ErrorKind::Usage, "info takes one input: a model or a built-in scene");

  const std::string& input = syntax.found_operands.front();
  ItemProcess process({.name = input == "-" ? "standard input" : input,
                       .load = options.limits,
                       .seconds = max_seconds,
                       .is_sandboxed = uses_sandbox(is_sandboxed, say_warning),
                       .readable = readable_paths(input, options)},
                      1, [&](std::size_t, ItemSender& sender) {
                        Scene scene;
                        within_import_time(input, options.limits, [&] { scene = load_scene(input, options); });
                        sender.has_read();
                        return packed_info(input, scene, prints_json);
                      });
  const std::vector<std::uint8_t> answer = process.next({});
  Unpacker unpacker(answer);
  print(unpacker.text());
  if (!prints_json)
    for (auto n = unpacker.value<std::uint64_t>(); n > 0; --n) say_warning(unpacker.text());
}

}  // namespace zoneplate::cli
