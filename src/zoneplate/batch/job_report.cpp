// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/job_report.h"

#include <fmt/format.h>

#include <utility>

#include "zoneplate/base/isa.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/report/report_version.h"

namespace zoneplate {

Json::Object summary_json(const Job& args, const Summary& summary) {
  Json::Object times, passes;
  for (const auto& [name, ms] : summary.times) times.emplace_back(name, ms);
  for (const Aov* aov : args.aovs) passes.emplace_back(aov->name, aov_path(summary.output, aov->name));
  return Json::Object{{"format", "zoneplate-render"},
                      {"version", report_version},
                      {"input", args.input},
                      {"output", summary.output},
                      {"data_passes", std::move(passes)},
                      {"width", summary.width},
                      {"height", summary.height},
                      {"method", args.method},
                      {"exposure", summary.exposure},
                      {"frames", summary.frames},
                      {"triangles", summary.counts.triangles},
                      {"triangles_set_up", summary.counts.triangles_set_up},
                      {"shaded_samples", summary.counts.shaded},
                      {"threads", summary.threads},
                      {"isa", name_of(args.isa)},
                      {"stage_ms", std::move(times)},
                      {"peak_memory_bytes", summary.peak_memory},
                      {"warnings", Json::Array(summary.warnings.begin(), summary.warnings.end())}};
}

std::string plan_text(const Job& args) {
  const std::optional<Crop>& crop = args.options.crop;
  return fmt::format("{} -> {}, {} × {}, {}", args.input, args.output, crop ? crop->width : args.options.width,
                     crop ? crop->height : args.options.height, args.method);
}

Json::Object plan_json(const Job& args, std::string_view status) {
  return {{"format", "zoneplate-render"},
          {"version", report_version},
          {"input", args.input},
          {"output", args.output},
          {"status", status}};
}

}  // namespace zoneplate
