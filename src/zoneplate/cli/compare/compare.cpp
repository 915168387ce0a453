// SPDX-License-Identifier: Apache-2.0
// zoneplate compare: measures antialiasing methods on scenes against one reference.
#include <fmt/format.h>

#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/compare/args.h"
#include "zoneplate/cli/compare/earlier.h"
#include "zoneplate/cli/confined.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/evaluate/compare/comparison.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/check.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/output_paths.h"
#include "zoneplate/report/plot.h"

namespace zoneplate::cli {
namespace {

ReadingLimits limits_of(const CompareArgs& args) {
  return {args.render.load.limits, args.render.max_seconds, args.render.is_sandboxed};
}

/// The files that a comparison may read.
std::vector<std::string> readable_paths_of(const CompareArgs& args, const TrialOptions& options) {
  std::vector<std::string> out = environment_files(args.render);
  for (const std::string& name : args.scenes)
    for (std::string& path : readable_paths(name, args.render.load)) out.push_back(std::move(path));
  if (!args.render.cache.empty()) out.push_back(args.render.cache);
  for (std::string& path : args.render.default_material.files()) out.push_back(std::move(path));
  if (options.is_reference_file) out.push_back(options.reference);
  out.insert(out.end(), args.ignored.masks.begin(), args.ignored.masks.end());
  return out;
}

}  // namespace

void run_compare(std::span<const std::string> arguments) {
  CompareArgs args;
  args.render.options.width = 640, args.render.options.height = 480;
  Syntax syntax = compare_syntax(args);
  if (!parse(syntax, arguments)) return;
  args.command = {"zoneplate", "compare"};
  args.command.insert(args.command.end(), arguments.begin(), arguments.end());
  args.scenes = scenes_of(syntax.found_operands);
  if (args.scenes.empty())
    throw Error(ErrorKind::Usage, "no scene: give models or built-in scenes, or all (zoneplate list scenes)");
  // Images are written as .png, whatever the name of their folder.
  const std::string folder = std::exchange(args.render.output, "-");
  check_job(args.render);
  args.render.output = folder;
  const TrialOptions options = trial_options(args);
  if (!args.page.empty()) check_savable(args.page);
  EarlierFiles earlier;
  if (args.replaces && !args.render.output.empty()) earlier = earlier_files(args.render.output, limits_of(args));
  if (args.page.empty() || !args.render.output.empty()) check_output_folder(args.render.output, earlier);
  check_scenes(args);
  if (args.render.verbosity == Verbosity::Quiet && !args.render.progress) args.render.progress = ProgressKind::None;
  // Throws before the work if plots cannot be drawn.
  if (!args.render.output.empty()) static_cast<void>(plot_svg({.x = {"x", 0, 1}, .y = {"y", 0, 1}}));
  Progress progress(args.render.progress ? *args.render.progress : parse_progress("auto"));
  args.prints_json = args.render.prints_json, args.is_quiet = args.render.verbosity == Verbosity::Quiet;
  ComparedFiles files(args, args.render);
  std::vector<std::uint8_t> text;
  std::optional<MemoryFiles> memory;
  const ConfinedRun run{
      .name = args.scenes.size() == 1 ? args.scenes[0] : fmt::format("{} scenes", args.scenes.size()),
      .limits = limits_of(args),
      .readable = readable_paths_of(args, options),
      .outputs = {},
      .progress = &progress,
      .open = [&] { memory.emplace(); },
      .take = [&](const std::string& path, std::vector<std::uint8_t> bytes) { files.take(path, std::move(bytes)); },
      .take_environment =
          [&](std::uint64_t key, const std::vector<std::uint8_t>& bytes) {
            store_environment(args.render.cache, key, bytes);
          }};
  with_isa(args.render.isa, [&] {
    with_threads(args.render.threads, [&] {
      text = run_confined(run, [&](Delivery& out) {
        Environments environments;
        const Environments::Store store = [&](std::uint64_t key, auto bytes) { out.sender().environment(key, bytes); };
        complete_environments(environments, args.render, store, out.sender());
        compare_all(args, args.render, options, *memory, out);
      });
    });
  });
  files.save(earlier);  // without other threads, as save_folder requires
  if (args.render.verbosity != Verbosity::Quiet || args.render.prints_json) print_report({text.begin(), text.end()});
}

}  // namespace zoneplate::cli
