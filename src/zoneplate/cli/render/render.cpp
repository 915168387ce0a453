// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/batch/input_names.h"
#include "zoneplate/batch/item_files.h"
#include "zoneplate/batch/items.h"
#include "zoneplate/batch/job_report.h"
#include "zoneplate/cli/render/batch.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/os/usage.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

void print_summary(const RenderArgs& args, const Summary& summary) {
  if (args.verbosity == Verbosity::Verbose) {
    std::string times;
    for (const auto& [name, ms] : summary.times) times += fmt::format("{} {:.1f} ms, ", name, ms);
    say_note(fmt::format("{}: {}x{}, {}, {} triangles, {} threads, {}", summary.output, summary.width, summary.height,
                         args.method, summary.counts.triangles, summary.threads, name_of(args.isa)));
    say_note(fmt::format("{}peak memory {} MB", times, summary.peak_memory >> 20));
  }
  const bool is_silent = args.verbosity != Verbosity::Normal || args.prints_json || args.output == "-";
  if (!is_silent && stderr_is_terminal())
    say_note(
        fmt::format("{}: {} × {}, {:.2f} s", summary.output, summary.width, summary.height, summary.total_ms() / 1000));
  if (!args.prints_json) return;
  print_report(Json(summary_json(args, summary)).text() + '\n', args.output == "-");
}

Summary render_item(const RenderArgs& args) {
  Progress progress(args.progress ? *args.progress : parse_progress("auto"));
  RunEvents events{.warn = say_warning};
  if (progress.is_shown()) events.progress = [&](std::string_view stage, double done) { progress.begin(stage, done); };
  return RenderItems({args}, std::move(events)).next();
}

}  // namespace

void run_render(std::span<const std::string> arguments) {
  std::optional<RenderArgs> parsed = parse_render_args(arguments);
  if (!parsed) return;
  RenderArgs& args = *parsed;
  if (args.verbosity == Verbosity::Quiet && !args.progress) args.progress = ProgressKind::None;
  if (args.is_batch()) {
    with_isa(args.isa, [&] { with_threads(args.threads, [&] { render_batch(args); }); });
    return;
  }
  static_cast<void>(upscale::make_method(args.method));
  check_own_files(args);
  if (args.is_dry_run) {
    check_input(args.input, args.load.format);
    return print(args.prints_json ? Json(plan_json(args, is_finished(args) ? "skipped" : "planned")).text() + '\n'
                                  : plan_text(args) + '\n');
  }
  check_outputs(args);
  if (is_finished(args)) {
    if (args.prints_json) print_report(Json(plan_json(args, "skipped")).text() + '\n');
    return;
  }
  Summary summary;
  with_isa(args.isa, [&] { with_threads(args.threads, [&] { summary = render_item(args); }); });
  if (args.verbosity != Verbosity::Quiet)
    for (const std::string& warning : summary.warnings) say_warning(warning);
  print_summary(args, summary);
}

}  // namespace zoneplate::cli
