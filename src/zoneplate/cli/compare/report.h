#pragma once

#include <string>
#include <vector>

#include "zoneplate/cli/compare/trial.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/table.h"

namespace zoneplate::cli {

/// A comparison as the figures say it: one table a scene, and one of the means over scenes and by class of failure.
std::string report_text(const std::vector<SceneTrials>& scenes);

/// One row a scene and method, every figure of it; numbers in the fewest digits that read back the same.
std::string report_csv(const std::vector<SceneTrials>& scenes);

/// The table of all methods on all scenes for a page in Markdown, the nearest to the references first, in bold what is
/// on the Pareto front of the means.
std::string report_markdown(const std::vector<SceneTrials>& scenes);

/// The version of the JSON's layout; it rises when a reader of the last one would misread the new one.
inline constexpr int report_version = 1;

/// Everything that is known of a comparison, with the names of its files, and the threads and the instruction set of
/// the innermost `with_threads` and `with_isa`.
Json report_json(const std::vector<SceneTrials>& scenes, const std::vector<std::string>& command);

/// The row of a method, over all scenes in which it has one.
struct MethodMeans {
  std::string method;
  double error = 0;                                      ///< mean FLIP
  double ms = 0, processor_ms = 0;                       ///< means of the scenes' least times
  std::vector<std::pair<std::string, double>> by_class;  ///< mean FLIP of the scenes of one class of failure
};
std::vector<MethodMeans> means_of(const std::vector<SceneTrials>& scenes);

/// The names of the files of a trial, within the comparison's folder.
struct TrialFiles {
  std::string picture, error_map, worst;
};
TrialFiles files_of(const SceneTrials& scene, const Trial& trial);

/// "ssaa:pattern=halton,samples=64" as part of a file's name: "ssaa-pattern-halton-samples-64".
std::string file_name_of(std::string_view spec);

}  // namespace zoneplate::cli
