// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/cli/compare/trial.h"
#include "zoneplate/cli/report_version.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/table.h"

namespace zoneplate::cli {

/// The results as text: one table per scene, and one of the means over scenes and by class of artifacts.
std::string report_text(const std::vector<SceneTrials>& scenes);

/// The results as CSV: one row per scene and method, with all figures; numbers in the fewest digits that round-trip.
std::string report_csv(const std::vector<SceneTrials>& scenes);

/// The table of all methods on all scenes in Markdown, in ascending order of error; methods on the Pareto front of the
/// means are bold.
std::string report_markdown(const std::vector<SceneTrials>& scenes);

/// The results as JSON, with the names of the comparison's files, and the threads and the instruction set of the
/// innermost `with_threads` and `with_isa`.
Json report_json(const std::vector<SceneTrials>& scenes, const std::vector<std::string>& command);

/// The means of a method over all scenes that it has rendered.
struct MethodMeans {
  std::string method;
  double error = 0;                                      ///< mean FLIP
  double ms = 0, processor_ms = 0;                       ///< means of the scenes' minimum times
  std::vector<std::pair<std::string, double>> by_class;  ///< mean FLIP of the scenes of one class of artifacts
};
std::vector<MethodMeans> means_of(const std::vector<SceneTrials>& scenes);

/// True if no other method has both less CPU time and less error.
bool is_on_front(const MethodMeans& own, const std::vector<MethodMeans>& all);

/// The trials of a scene in ascending order of their error.
std::vector<const Trial*> ranked(const SceneTrials& scene);

/// The figures of a scene's methods, in that order.
Table results_of(const SceneTrials& scene);

/// The names of the files of a trial, within the comparison's folder.
struct TrialFiles {
  std::string picture, error_map, worst;
};
TrialFiles files_of(const SceneTrials& scene, const Trial& trial);

/// "ssaa:pattern=halton,samples=64" as part of a file's name: "ssaa-pattern-halton-samples-64".
std::string file_name_of(std::string_view spec);

}  // namespace zoneplate::cli
