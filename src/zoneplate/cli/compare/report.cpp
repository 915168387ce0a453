// SPDX-License-Identifier: Apache-2.0
// The results of a comparison as text, CSV, Markdown and JSON.
#include "zoneplate/cli/compare/report.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/utf8.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "zoneplate/version.h"

namespace zoneplate::cli {
namespace {

/// A column of the tables: a figure by its name, and its format.
struct Column {
  std::string name, head;
  int decimals = significant;
  double scale = 1;
  static constexpr int significant = -1;  ///< four significant digits
};

/// The figures that have columns of their own, and their formats.
const Column known_columns[] = {{"psnr", "PSNR dB", 2},
                                {"ssim", "SSIM", 4},
                                {"flip", "FLIP ×1000", 2, 1000},
                                {"edge_error", "edges %", 2, 100},
                                {"edge_error.near_axis", "near axis %", 2, 100},
                                {"edge_error.diagonal", "diagonal %", 2, 100}};

/// The columns of the measured metrics, in their order.
std::vector<Column> columns_of(std::span<const SceneTrials> scenes) {
  std::vector<Column> columns;
  const auto add = [&](const Column& column) {
    if (std::ranges::find(columns, column.name, &Column::name) == columns.end()) columns.push_back(column);
  };
  for (const SceneTrials& scene : scenes)
    for (const Trial& trial : scene.trials)
      for (const metrics::Result& result : trial.results) {
        const std::string name(result.metric->name);
        bool is_known = false;
        for (const Column& known : known_columns)
          if (known.name == name || known.name.starts_with(name + ".")) add(known), is_known = true;
        if (!is_known)
          add({name, result.metric->unit.empty() ? name : fmt::format("{} {}", name, result.metric->unit)});
      }
  return columns;
}

std::string shown(std::optional<double> value, int decimals, double scale = 1) {
  if (!value) return "-";
  if (decimals == Column::significant) return fmt::format("{:.4g}", *value * scale);
  return std::isfinite(*value) ? fmt::format("{:.{}f}", *value * scale, decimals) : "same";
}

std::string megabytes(const std::optional<std::uint64_t>& bytes) {
  return bytes ? fmt::format("{:.1f}", static_cast<double>(*bytes) / (1 << 20)) : "-";
}

Table table_of(const SceneTrials& scene, const std::vector<Column>& columns) {
  Table table{{"method"}, {}};
  for (const Column& c : columns) table.head.emplace_back(c.head);
  for (const char* name : {"ms", "CPU ms", "samples/px", "MB"}) table.head.emplace_back(name);
  for (const Trial* t : ranked(scene)) {
    std::vector<std::string> row{t->method};
    for (const Column& c : columns) row.push_back(shown(t->value(c.name), c.decimals, c.scale));
    row.push_back(fmt::format("{:.1f}", t->least_ms()));
    row.push_back(fmt::format("{:.1f}", t->least_processor_ms()));
    row.push_back(fmt::format("{:.2f}", t->shaded_per_pixel()));
    row.push_back(megabytes(t->memory));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The table for a terminal, with the Pareto front marked.
Table marked_table(const SceneTrials& scene, const std::vector<Column>& columns) {
  Table table = table_of(scene, columns);
  const std::vector<const Trial*> order = ranked(scene);
  for (std::size_t i = 0; i < order.size(); ++i) table.rows[i][0].insert(0, order[i]->is_on_front ? "* " : "  ");
  return table;
}

/// The cost of the reference, which the methods' times do not include.
std::string reference_cost(const SceneTrials& scene) {
  if (!scene.reference_ms) return "";
  const double pixels = static_cast<double>(scene.reference_picture.values().size());
  return fmt::format(" ({:.1f} ms, {:.1f} CPU ms, {:.2f} shaded samples per pixel)", *scene.reference_ms,
                     *scene.reference_processor_ms, static_cast<double>(scene.reference_shaded) / pixels);
}

/// A note on methods with fewer turns because of their time: a minimum over fewer turns is less reliable.
std::string fewer_turns(const SceneTrials& scene) {
  std::string text;
  for (const Trial& t : scene.trials)
    if (static_cast<int>(t.frame_ms.size()) < scene.turns)
      text += fmt::format("{} {} ({})", text.empty() ? "" : ",", t.method, t.frame_ms.size());
  return text.empty() ? "" : fmt::format("Slow methods with fewer than {} turns:{}\n", scene.turns, text);
}

/// The class of a scene, "other" for a scene without one.
std::string class_of(const SceneTrials& scene) { return scene.failure.empty() ? "other" : scene.failure; }

std::string means_text(const std::vector<SceneTrials>& scenes) {
  std::vector<MethodMeans> means = means_of(scenes);
  std::ranges::stable_sort(means, {}, &MethodMeans::error);
  Table table{{"method", "mean"}, {}};
  for (const auto& [name, error] : means.at(0).by_class) table.head.push_back(name);
  table.head.emplace_back("CPU ms");
  for (const MethodMeans& m : means) {
    std::vector<std::string> row{m.method, shown(m.error, 2, 1000)};
    for (const auto& [name, error] : m.by_class) row.push_back(shown(error, 2, 1000));
    row.push_back(fmt::format("{:.1f}", m.processor_ms));
    table.rows.push_back(std::move(row));
  }
  return "All scenes: FLIP ×1000, mean and by class of artifacts; mean CPU time\n" + table_text(table);
}

Json number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value) : Json(); }

Json numbers(const std::vector<double>& values) { return Json::Array(values.begin(), values.end()); }

Json metrics_json(const Trial& trial) {
  Json::Object out;
  for (const metrics::Result& result : trial.results) {
    Json::Object row{{"value", number(result.value)},
                     {"unit", result.metric->unit},
                     {"better", result.metric->better == metrics::Better::Lower ? "lower" : "higher"}};
    Json::Object figures, curves;
    for (const metrics::Figure& f : result.score.more) figures.emplace_back(f.name, number(f.value));
    for (const metrics::Curve& c : result.score.curves)
      curves.emplace_back(
          c.name,
          Json::Object{{"x_label", c.x_label}, {"y_label", c.y_label}, {"x", numbers(c.x)}, {"y", numbers(c.y)}});
    row.emplace_back("figures", std::move(figures));
    row.emplace_back("curves", std::move(curves));
    out.emplace_back(result.metric->name, std::move(row));
  }
  return out;
}

Json place_json(const Place& p) {
  return Json::Object{{"x", p.x}, {"y", p.y}, {"width", Place::side}, {"height", Place::side}, {"error", p.error}};
}

Json trial_json(const SceneTrials& scene, const Trial& trial) {
  const TrialFiles files = files_of(scene, trial);
  Json::Array worst;
  for (const Place& p : trial.worst) worst.push_back(place_json(p));
  return Json::Object{{"method", trial.method},
                      {"image", files.picture},
                      {"error_map", files.error_map},
                      {"worst_regions_image", files.worst},
                      {"metrics", metrics_json(trial)},
                      {"frame_ms", trial.least_ms()},
                      {"frame_ms_by_turn", numbers(trial.frame_ms)},
                      {"cpu_ms", trial.least_processor_ms()},
                      {"cpu_ms_by_turn", numbers(trial.processor_ms)},
                      {"stage_ms", Json::Object{{"prepare", trial.counts.prepare_ms},
                                                {"geometry", trial.counts.geometry_ms},
                                                {"tiles", trial.counts.tiles_ms},
                                                {"resolve", trial.counts.resolve_ms},
                                                {"display", trial.counts.display_ms},
                                                {"filter", trial.counts.filter_ms}}},
                      {"triangles", trial.counts.triangles},
                      {"shaded_samples", trial.counts.shaded},
                      {"shaded_samples_per_pixel", trial.shaded_per_pixel()},
                      {"peak_memory_bytes", trial.memory ? Json(*trial.memory) : Json()},
                      {"is_pareto_optimal", trial.is_on_front},
                      {"worst_regions", std::move(worst)}};
}

Json scene_json(const SceneTrials& scene) {
  Json::Array trials;
  for (const Trial& t : scene.trials) trials.push_back(trial_json(scene, t));
  return Json::Object{{"scene", scene.scene},
                      {"folder", scene.name},
                      {"class", scene.failure.empty() ? Json() : Json(scene.failure)},
                      {"artifact", scene.complaint.empty() ? Json() : Json(scene.complaint)},
                      {"width", scene.reference_picture.width()},
                      {"height", scene.reference_picture.height()},
                      {"reference", Json::Object{{"source", scene.reference},
                                                 {"image", scene.name + "/reference.png"},
                                                 {"frame_ms", number(scene.reference_ms)},
                                                 {"cpu_ms", number(scene.reference_processor_ms)},
                                                 {"shaded_samples", scene.reference_shaded}}},
                      {"turns", scene.turns},
                      {"worst_region", place_json(scene.common_worst)},
                      {"crops", scene.name + "/crops.png"},
                      {"plot", scene.name + "/cost.svg"},
                      {"methods", std::move(trials)}};
}

}  // namespace

std::string file_name_of(std::string_view spec) {
  std::string name;
  for (const char c : spec) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.';
    if (is_plain && !(c == '.' && name.empty()))
      name += c;
    else if (!name.empty() && name.back() != '-')
      name += '-';
  }
  while (name.ends_with('-')) name.pop_back();
  return name.substr(0, 100);
}

TrialFiles files_of(const SceneTrials& scene, const Trial& trial) {
  const std::string stem = scene.name + '/' + file_name_of(trial.method);
  return {stem + ".png", stem + ".error.png", stem + ".worst.png"};
}

std::vector<MethodMeans> means_of(const std::vector<SceneTrials>& scenes) {
  struct Sum {
    double error = 0, count = 0;
  };
  std::vector<std::string> classes;
  for (const SceneTrials& s : scenes)
    if (std::ranges::find(classes, class_of(s)) == classes.end()) classes.push_back(class_of(s));
  std::vector<MethodMeans> out;
  for (std::size_t m = 0; m < scenes.at(0).trials.size(); ++m) {
    MethodMeans& means = out.emplace_back(MethodMeans{.method = scenes[0].trials[m].method});
    std::map<std::string, Sum> by_class;
    for (const SceneTrials& s : scenes) {
      const double error = s.trials[m].value("flip").value_or(0);
      Sum& sum = by_class[class_of(s)];
      sum.error += error, sum.count += 1;
      means.error += error / static_cast<double>(scenes.size());
      means.ms += s.trials[m].least_ms() / static_cast<double>(scenes.size());
      means.processor_ms += s.trials[m].least_processor_ms() / static_cast<double>(scenes.size());
    }
    for (const std::string& c : classes) means.by_class.emplace_back(c, by_class[c].error / by_class[c].count);
  }
  return out;
}

std::vector<const Trial*> ranked(const SceneTrials& scene) {
  std::vector<const Trial*> order;
  for (const Trial& t : scene.trials) order.push_back(&t);
  std::ranges::stable_sort(order, {}, [](const Trial* t) { return t->value("flip").value_or(HUGE_VAL); });
  return order;
}

Table results_of(const SceneTrials& scene) { return table_of(scene, columns_of({&scene, 1})); }

bool is_on_front(const MethodMeans& own, const std::vector<MethodMeans>& all) {
  return std::ranges::none_of(all, [&](const MethodMeans& m) {
    return m.error <= own.error && m.processor_ms <= own.processor_ms &&
           (m.error < own.error || m.processor_ms < own.processor_ms);
  });
}

std::string report_text(const std::vector<SceneTrials>& scenes) {
  const std::vector<Column> columns = columns_of(scenes);
  std::string text;
  for (const SceneTrials& s : scenes) {
    text +=
        fmt::format("{}{}, {}x{}, against {}{}\n", printable(s.scene), s.failure.empty() ? "" : " (" + s.failure + ")",
                    s.reference_picture.width(), s.reference_picture.height(), s.reference, reference_cost(s));
    text += table_text(marked_table(s, columns)) + fewer_turns(s) + '\n';
  }
  if (scenes.size() > 1) text += means_text(scenes) + '\n';
  return text + "* on the Pareto front: no other method has less CPU time and less error\n";
}

std::string report_csv(const std::vector<SceneTrials>& scenes) {
  const std::vector<Column> columns = columns_of(scenes);
  std::string text = "scene,class,method";
  for (const Column& c : columns) text += fmt::format(",{}", c.name);
  text += ",frame_ms,cpu_ms,shaded_samples,shaded_samples_per_pixel,peak_memory_bytes,is_pareto_optimal\n";
  // Parameters of methods contain commas, the separator of fields.
  const auto quoted = [](const std::string& s) {
    return s.find_first_of(",\"\n") == std::string::npos ? s : fmt::format("\"{}\"", s);
  };
  for (const SceneTrials& s : scenes)
    for (const Trial& t : s.trials) {
      text += fmt::format("{},{},{}", quoted(s.scene), s.failure, quoted(t.method));
      for (const Column& c : columns) {
        const std::optional<double> value = t.value(c.name);
        text += value ? fmt::format(",{}", *value) : ",";
      }
      text += fmt::format(",{},{},{},{},{},{}\n", t.least_ms(), t.least_processor_ms(), t.counts.shaded,
                          t.shaded_per_pixel(), t.memory ? std::to_string(*t.memory) : "", t.is_on_front ? 1 : 0);
    }
  return text;
}

namespace {

/// The mean of a figure over the scenes that have it.
template <class Figure>
std::optional<double> mean_over(const std::vector<SceneTrials>& scenes, const Figure& figure) {
  double sum = 0, count = 0;
  for (const SceneTrials& s : scenes)
    if (const std::optional<double> value = figure(s)) sum += *value, count += 1;
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

}  // namespace

std::string report_markdown(const std::vector<SceneTrials>& scenes) {
  const std::vector<MethodMeans> means = means_of(scenes);
  std::vector<std::size_t> order(means.size());
  for (std::size_t m = 0; m < order.size(); ++m) order[m] = m;
  std::ranges::stable_sort(order, {}, [&](std::size_t m) { return means[m].error; });
  std::string text = "| method | mean |", rule = "|---|---|";
  for (const SceneTrials& s : scenes) text += fmt::format(" {} |", s.name), rule += "---|";
  text += " near axis % | samples/px | MB | ms |\n" + rule + "---|---|---|---|\n";
  for (const std::size_t m : order) {
    const char* mark = is_on_front(means[m], means) ? "**" : "";
    text += fmt::format("| {0}`{1}`{0} | {2} |", mark, means[m].method, shown(means[m].error, 1, 1000));
    for (const SceneTrials& s : scenes) text += fmt::format(" {} |", shown(s.trials[m].value("flip"), 1, 1000));
    const auto mean = [&](const auto& figure) {
      return mean_over(scenes, [&](const SceneTrials& s) -> std::optional<double> { return figure(s.trials[m]); });
    };
    const auto near_axis = mean([](const Trial& t) { return t.value("edge_error.near_axis"); });
    const auto bytes = mean([](const Trial& t) -> std::optional<double> {
      return t.memory ? std::optional(static_cast<double>(*t.memory) / (1 << 20)) : std::nullopt;
    });
    text += fmt::format(" {} | {} | {} | {} |\n", shown(near_axis, 1, 100),
                        shown(mean([](const Trial& t) { return std::optional(t.shaded_per_pixel()); }), 1),
                        shown(bytes, 0), shown(means[m].processor_ms, 0));
  }
  return text;
}

Json report_json(const std::vector<SceneTrials>& scenes, const std::vector<std::string>& command) {
  Json::Array rows, means;
  for (const SceneTrials& s : scenes) rows.push_back(scene_json(s));
  for (const MethodMeans& m : means_of(scenes)) {
    Json::Object by_class;
    for (const auto& [name, error] : m.by_class) by_class.emplace_back(name, error);
    means.emplace_back(Json::Object{{"method", m.method},
                                    {"flip", m.error},
                                    {"frame_ms", m.ms},
                                    {"cpu_ms", m.processor_ms},
                                    {"flip_by_class", std::move(by_class)}});
  }
  return Json::Object{{"format", "zoneplate-compare"},
                      {"version", report_version},
                      {"program", version},
                      {"command", Json::Array(command.begin(), command.end())},
                      {"threads", thread_limit()},
                      {"isa", name_of(current_isa())},
                      {"plot", "cost.svg"},
                      {"scenes", std::move(rows)},
                      {"means", std::move(means)}};
}

}  // namespace zoneplate::cli
