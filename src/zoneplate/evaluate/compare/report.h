// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/evaluate/compare/trial.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/report_version.h"
#include "zoneplate/report/table.h"

namespace zoneplate {

/// The regions that are not measured, as the command states them; empty if there are none.
std::string ignored_text(const SceneTrials& scene);

/// The results as text: one table per scene, and one of the means over scenes and by class of artifacts.
std::string report_text(const std::vector<SceneTrials>& scenes);

/// The results as CSV: one row per scene and method, with all figures; numbers in the fewest digits that round-trip.
std::string report_csv(const std::vector<SceneTrials>& scenes);

/// The table of all methods on all scenes in Markdown, the best first: the ranking metric by scene, and the means of
/// all metrics. Methods on the Pareto front of the means are bold.
std::string report_markdown(const std::vector<SceneTrials>& scenes);

/// The results as JSON, with the names of the comparison's files, and the threads and the instruction set of the
/// innermost `with_threads` and `with_isa`.
Json report_json(const std::vector<SceneTrials>& scenes, const std::vector<std::string>& command);

/// A column of the tables: a metric or one of its additional figures, and its format.
struct Column {
  std::string name, head;  ///< "edge_error.near_axis", "near axis %"
  int decimals = significant;
  double scale = 1;
  metrics::Better better = metrics::Better::Lower;
  static constexpr int significant = -1;  ///< four significant digits

  /// True if 0 is the best value, so that a logarithmic axis suits it.
  bool is_error() const { return better == metrics::Better::Lower; }
  std::string text(std::optional<double> value) const;
};

/// The column of the metric itself.
Column ranking_column(const metrics::Metric& metric);

/// The means of a method over the scenes in which a figure was measured.
struct MethodMeans {
  std::string method;
  std::vector<std::optional<double>> values;  ///< of columns_of(scenes): the first one ranks
  double ms = 0, cpu_ms = 0, shaded_per_pixel = 0;
  std::optional<double> memory;  ///< bytes
  /// Of the ranking metric over the scenes of one class of artifacts.
  std::vector<std::pair<std::string, std::optional<double>>> by_class;
  bool is_on_front = false;

  std::optional<double> rank() const { return values.at(0); }
};
std::vector<MethodMeans> means_of(const std::vector<SceneTrials>& scenes);

/// The trials of a scene, the best first, by the ranking metric.
std::vector<const Trial*> ranked(const SceneTrials& scene);
/// The indices of the means in the same order.
std::vector<std::size_t> ranked(const std::vector<MethodMeans>& means, const metrics::Metric& metric);

/// The figures of a scene's methods, in that order.
Table results_of(const SceneTrials& scene);
/// The means, in that order.
Table means_table(const std::vector<SceneTrials>& scenes, const std::vector<MethodMeans>& means);

/// "FLIP ×1000 4.32, 9.9 ms": a trial's value of the ranking metric, and its CPU time.
std::string facts_of(const SceneTrials& scene, const Trial& trial);

/// The names of the files of a trial, within the comparison's folder.
struct TrialFiles {
  std::string picture, error_map, worst;
};
TrialFiles files_of(const SceneTrials& scene, const Trial& trial);

/// "ssaa:pattern=halton,samples=64" as part of a file's name: "ssaa-pattern-halton-samples-64".
std::string file_name_of(std::string_view spec);

}  // namespace zoneplate
