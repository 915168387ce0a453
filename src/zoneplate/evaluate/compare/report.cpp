// SPDX-License-Identifier: Apache-2.0
// The results of a comparison as text, CSV, Markdown and JSON.
#include "zoneplate/evaluate/compare/report.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/utf8.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "zoneplate/version.h"

namespace zoneplate {
namespace {

/// The figures that have columns of their own, and their formats.
const Column known_columns[] = {{"psnr", "PSNR dB", 2},
                                {"ssim", "SSIM", 4},
                                {"flip", "FLIP ×1000", 2, 1000},
                                {"cvvdp", "cvvdp JOD", 3},
                                {"cvvdp_video", "JOD", 3},
                                {"flicker", "flicker %", 2, 100},
                                {"tpsnr", "tPSNR dB", 2},
                                {"edge_error", "edges %", 2, 100},
                                {"edge_error.near_axis", "near axis %", 2, 100},
                                {"edge_error.diagonal", "diagonal %", 2, 100}};

Column column_of(const metrics::Metric& metric, const Column& known) {
  Column out = known;
  out.better = metric.better;
  return out;
}

/// The columns of the measured metrics, in their order; the first is that of the ranking metric.
std::vector<Column> columns_of(std::span<const SceneTrials> scenes) {
  std::vector<Column> columns{ranking_column(*scenes[0].ranking)};
  const auto add = [&](const Column& column) {
    if (std::ranges::find(columns, column.name, &Column::name) == columns.end()) columns.push_back(column);
  };
  for (const SceneTrials& scene : scenes)
    for (const Trial& trial : scene.trials)
      for (const metrics::Result& result : trial.results) {
        add(ranking_column(*result.metric));
        for (const Column& known : known_columns)
          if (known.name.starts_with(fmt::format("{}.", result.metric->name))) add(column_of(*result.metric, known));
      }
  return columns;
}

std::string shown(std::optional<double> value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string megabytes(const std::optional<std::uint64_t>& bytes) {
  return bytes ? fmt::format("{:.1f}", static_cast<double>(*bytes) / (1 << 20)) : "-";
}

Table table_of(const SceneTrials& scene, const std::vector<Column>& columns) {
  Table table{{"method"}, {}};
  for (const Column& c : columns) table.head.emplace_back(c.head);
  for (const char* name : {"ms", "CPU ms", "samples/px", "MB"}) table.head.emplace_back(name);
  const bool has_history =
      std::ranges::any_of(scene.trials, [](const Trial& t) { return !t.is_sequence && t.frames > 1; });
  if (has_history) table.head.emplace_back("frames");
  for (const Trial* t : ranked(scene)) {
    std::vector<std::string> row{t->method};
    for (const Column& c : columns) row.push_back(c.text(t->value(c.name)));
    row.push_back(shown(t->ms(), 1));
    row.push_back(shown(t->cpu_ms(), 1));
    row.push_back(shown(t->shaded_per_pixel(), 2));
    row.push_back(megabytes(t->memory));
    if (has_history) row.push_back(std::to_string(t->frames));
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
  if (!scene.reference_cost) return "";
  const Trial& cost = *scene.reference_cost;
  std::string text = fmt::format(" ({:.1f} ms, {:.1f} CPU ms, {:.2f} shaded samples per pixel", cost.ms(),
                                 cost.cpu_ms(), cost.shaded_per_pixel());
  if (scene.reference_error) text += fmt::format(", estimated error {:.2g}", *scene.reference_error);
  return text + ")";
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
  const Column ranking = ranking_column(*scenes[0].ranking);
  return fmt::format("All scenes: {}, mean and by class of artifacts; means of the other metrics and of the costs\n{}",
                     ranking.head, table_text(means_table(scenes, means_of(scenes))));
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
                      {"frames", trial.frames},
                      {"frame_ms", trial.ms()},
                      {"frame_ms_by_turn", numbers(trial.frame_ms)},
                      {"cpu_ms", trial.cpu_ms()},
                      {"cpu_ms_by_turn", numbers(trial.processor_ms)},
                      {"stage_ms", Json::Object{{"prepare", trial.counts.prepare_ms / trial.frames},
                                                {"geometry", trial.counts.geometry_ms / trial.frames},
                                                {"tiles", trial.counts.tiles_ms / trial.frames},
                                                {"resolve", trial.counts.resolve_ms / trial.frames},
                                                {"display", trial.counts.display_ms / trial.frames},
                                                {"filter", trial.counts.filter_ms / trial.frames}}},
                      {"triangles", trial.counts.triangles},
                      {"shaded_samples", trial.shaded()},
                      {"shaded_samples_per_pixel", trial.shaded_per_pixel()},
                      {"peak_memory_bytes", trial.memory ? Json(*trial.memory) : Json()},
                      {"is_pareto_optimal", trial.is_on_front},
                      {"worst_regions", std::move(worst)}};
}

Json scene_json(const SceneTrials& scene) {
  Json::Array trials;
  for (const Trial& t : scene.trials) trials.push_back(trial_json(scene, t));
  const std::optional<Trial>& cost = scene.reference_cost;
  return Json::Object{{"scene", scene.scene},
                      {"folder", scene.name},
                      {"class", scene.failure.empty() ? Json() : Json(scene.failure)},
                      {"artifact", scene.complaint.empty() ? Json() : Json(scene.complaint)},
                      {"width", scene.reference_picture.width()},
                      {"height", scene.reference_picture.height()},
                      {"reference", Json::Object{{"source", scene.reference},
                                                 {"image", scene.name + "/reference.png"},
                                                 {"frame_ms", cost ? Json(cost->ms()) : Json()},
                                                 {"cpu_ms", cost ? Json(cost->cpu_ms()) : Json()},
                                                 {"shaded_samples", cost ? Json(cost->shaded()) : Json()},
                                                 {"estimated_error", number(scene.reference_error)}}},
                      {"turns", scene.turns},
                      {"ignored", Json::Array(scene.ignored_texts.begin(), scene.ignored_texts.end())},
                      {"worst_region", place_json(scene.common_worst)},
                      {"crops", scene.name + "/crops.png"},
                      {"plot", scene.name + "/cost.svg"},
                      {"methods", std::move(trials)}};
}

}  // namespace

std::string Column::text(std::optional<double> value) const {
  if (!value) return "-";
  if (decimals == significant) return fmt::format("{:.4g}", *value * scale);
  return std::isfinite(*value) ? shown(*value * scale, decimals) : "same";
}

Column ranking_column(const metrics::Metric& metric) {
  for (const Column& known : known_columns)
    if (known.name == metric.name) return column_of(metric, known);
  const std::string name(metric.name);
  return column_of(metric, {name, metric.unit.empty() ? name : fmt::format("{} {}", name, metric.unit)});
}

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
  const std::vector<Column> columns = columns_of(scenes);
  std::vector<std::string> classes;
  for (const SceneTrials& s : scenes)
    if (std::ranges::find(classes, class_of(s)) == classes.end()) classes.push_back(class_of(s));
  std::vector<MethodMeans> out;
  for (std::size_t m = 0; m < scenes.at(0).trials.size(); ++m) {
    MethodMeans& means = out.emplace_back(MethodMeans{.method = scenes[0].trials[m].method});
    const auto mean = [&](const auto& figure, const std::string& artifacts = "") -> std::optional<double> {
      double sum = 0, count = 0;
      for (const SceneTrials& s : scenes) {
        const std::optional<double> value = figure(s.trials[m]);
        if (value && (artifacts.empty() || class_of(s) == artifacts)) sum += *value, count += 1;
      }
      return count > 0 ? std::optional(sum / count) : std::nullopt;
    };
    for (const Column& c : columns) means.values.push_back(mean([&](const Trial& t) { return t.value(c.name); }));
    means.ms = *mean([](const Trial& t) { return std::optional(t.ms()); });
    means.cpu_ms = *mean([](const Trial& t) { return std::optional(t.cpu_ms()); });
    means.shaded_per_pixel = *mean([](const Trial& t) { return std::optional(t.shaded_per_pixel()); });
    means.memory =
        mean([](const Trial& t) { return t.memory ? std::optional(static_cast<double>(*t.memory)) : std::nullopt; });
    for (const std::string& c : classes)
      means.by_class.emplace_back(c, mean([&](const Trial& t) { return t.value(columns[0].name); }, c));
  }
  std::vector<CostPoint> points;
  for (const MethodMeans& m : out) points.push_back({m.cpu_ms, m.rank()});
  for (std::size_t m = 0; m < out.size(); ++m) out[m].is_on_front = is_on_front(points[m], points, *scenes[0].ranking);
  return out;
}

std::vector<const Trial*> ranked(const SceneTrials& scene) {
  std::vector<const Trial*> order;
  for (const Trial& t : scene.trials) order.push_back(&t);
  const std::string_view name = scene.ranking->name;
  std::ranges::stable_sort(
      order, [&](const Trial* a, const Trial* b) { return is_better(*scene.ranking, a->value(name), b->value(name)); });
  return order;
}

std::vector<std::size_t> ranked(const std::vector<MethodMeans>& means, const metrics::Metric& metric) {
  std::vector<std::size_t> order(means.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return is_better(metric, means[a].rank(), means[b].rank()); });
  return order;
}

Table results_of(const SceneTrials& scene) { return table_of(scene, columns_of({&scene, 1})); }

Table means_table(const std::vector<SceneTrials>& scenes, const std::vector<MethodMeans>& means) {
  const std::vector<Column> columns = columns_of(scenes);
  Table table{{"method", columns[0].head}, {}};
  for (const auto& [name, value] : means.at(0).by_class) table.head.push_back(name);
  for (std::size_t c = 1; c < columns.size(); ++c) table.head.push_back(columns[c].head);
  for (const char* name : {"CPU ms", "samples/px", "MB"}) table.head.emplace_back(name);
  for (const std::size_t i : ranked(means, *scenes[0].ranking)) {
    const MethodMeans& m = means[i];
    std::vector<std::string> row{m.method, columns[0].text(m.rank())};
    for (const auto& [name, value] : m.by_class) row.push_back(columns[0].text(value));
    for (std::size_t c = 1; c < columns.size(); ++c) row.push_back(columns[c].text(m.values[c]));
    row.push_back(shown(m.cpu_ms, 1));
    row.push_back(shown(m.shaded_per_pixel, 2));
    row.push_back(m.memory ? megabytes(static_cast<std::uint64_t>(*m.memory)) : "-");
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string facts_of(const SceneTrials& scene, const Trial& trial) {
  const Column column = ranking_column(*scene.ranking);
  return fmt::format("{} {}, {:.1f} ms", column.head, column.text(trial.value(column.name)), trial.cpu_ms());
}

std::string ignored_text(const SceneTrials& scene) { return fmt::format("{}", fmt::join(scene.ignored_texts, ", ")); }

std::string report_text(const std::vector<SceneTrials>& scenes) {
  const std::vector<Column> columns = columns_of(scenes);
  std::string text;
  for (const SceneTrials& s : scenes) {
    text +=
        fmt::format("{}{}, {}x{}, against {}{}\n", printable(s.scene), s.failure.empty() ? "" : " (" + s.failure + ")",
                    s.reference_picture.width(), s.reference_picture.height(), s.reference, reference_cost(s));
    if (!s.ignored_texts.empty()) text += "ignored: " + printable(ignored_text(s)) + '\n';
    text += table_text(marked_table(s, columns)) + fewer_turns(s) + '\n';
  }
  if (scenes.size() > 1) text += means_text(scenes) + '\n';
  return text + fmt::format("* on the Pareto front: no other method has less CPU time and a better {}\n",
                            scenes.at(0).ranking->name);
}

std::string report_csv(const std::vector<SceneTrials>& scenes) {
  const std::vector<Column> columns = columns_of(scenes);
  std::string text = "scene,class,method";
  for (const Column& c : columns) text += fmt::format(",{}", c.name);
  text += ",frame_ms,cpu_ms,shaded_samples,shaded_samples_per_pixel,peak_memory_bytes,is_pareto_optimal,frames\n";
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
      text += fmt::format(",{},{},{},{},{},{},{}\n", t.ms(), t.cpu_ms(), t.shaded(), t.shaded_per_pixel(),
                          t.memory ? std::to_string(*t.memory) : "", t.is_on_front ? 1 : 0, t.frames);
    }
  return text;
}

std::string report_markdown(const std::vector<SceneTrials>& scenes) {
  const std::vector<MethodMeans> means = means_of(scenes);
  const std::vector<Column> columns = columns_of(scenes);
  std::string text = fmt::format("| method | mean {} |", columns[0].head), rule = "|---|---|";
  const auto add_head = [&](const std::string& head) { text += fmt::format(" {} |", head), rule += "---|"; };
  for (const SceneTrials& s : scenes) add_head(s.name);
  for (std::size_t c = 1; c < columns.size(); ++c) add_head(columns[c].head);
  for (const char* name : {"samples/px", "MB", "ms"}) add_head(name);
  text += '\n' + rule + '\n';
  for (const std::size_t i : ranked(means, *scenes[0].ranking)) {
    const MethodMeans& m = means[i];
    const char* mark = m.is_on_front ? "**" : "";
    text += fmt::format("| {0}`{1}`{0} | {2} |", mark, m.method, columns[0].text(m.rank()));
    for (const SceneTrials& s : scenes)
      text += fmt::format(" {} |", columns[0].text(s.trials[i].value(columns[0].name)));
    for (std::size_t c = 1; c < columns.size(); ++c) text += fmt::format(" {} |", columns[c].text(m.values[c]));
    text += fmt::format(" {} | {} | {} |\n", shown(m.shaded_per_pixel, 1),
                        m.memory ? shown(*m.memory / (1 << 20), 0) : "-", shown(m.cpu_ms, 0));
  }
  return text;
}

Json report_json(const std::vector<SceneTrials>& scenes, const std::vector<std::string>& command) {
  Json::Array rows, means;
  for (const SceneTrials& s : scenes) rows.push_back(scene_json(s));
  const std::vector<Column> columns = columns_of(scenes);
  for (const MethodMeans& m : means_of(scenes)) {
    Json::Object values, by_class;
    for (std::size_t c = 0; c < columns.size(); ++c) values.emplace_back(columns[c].name, number(m.values[c]));
    for (const auto& [name, value] : m.by_class) by_class.emplace_back(name, number(value));
    means.emplace_back(Json::Object{{"method", m.method},
                                    {"metrics", std::move(values)},
                                    {"by_class", std::move(by_class)},
                                    {"frame_ms", m.ms},
                                    {"cpu_ms", m.cpu_ms},
                                    {"shaded_samples_per_pixel", m.shaded_per_pixel},
                                    {"peak_memory_bytes", number(m.memory)},
                                    {"is_pareto_optimal", m.is_on_front}});
  }
  return Json::Object{{"format", "zoneplate-compare"},
                      {"version", report_version},
                      {"program", version},
                      {"command", Json::Array(command.begin(), command.end())},
                      {"threads", thread_limit()},
                      {"isa", name_of(current_isa())},
                      {"plot", "cost.svg"},
                      {"ranked_by", scenes.at(0).ranking->name},
                      {"scenes", std::move(rows)},
                      {"means", std::move(means)}};
}

}  // namespace zoneplate
