// SPDX-License-Identifier: Apache-2.0
// zoneplate metrics: the difference between images and a reference, by any of the catalogue's metrics.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/report_version.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/metrics/picture_file.h"
#include "zoneplate/os/file.h"
#include "zoneplate/report/json.h"

namespace zoneplate::cli {
namespace {

using metrics::Choice;
using metrics::Comparison;
using metrics::Metric;
using metrics::Result;

/// A metric's threshold.
struct Bound {
  const Metric* metric = nullptr;
  double value = 0;
};

struct MetricsArgs {
  std::string metric_names, map_path, threshold;
  int threads = 0;
  bool prints_json = false;
};

std::vector<Choice> choose(const std::string& names) {
  if (names.empty()) return metrics::default_choices(metrics::metrics());
  std::vector<Choice> choices;
  for (const std::string& name : split_specs(names)) {
    choices.push_back(metrics::choose_metric(metrics::metrics(), name));
  }
  return choices;
}

double parse_bound(const std::string& text) {
  if (text == "inf") return HUGE_VAL;
  if (text == "-inf") return -HUGE_VAL;
  return parse_number(text, -1e300, 1e300);
}

/// Parses thresholds: "40" for a single metric, or "psnr=40,ssim=0.98".
std::vector<Bound> parse_bounds(const std::string& text, const std::vector<Choice>& choices) {
  std::vector<Bound> bounds;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.size(), text.find(',', start));
    const std::string item = text.substr(start, end - start);
    start = end + 1;
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos) {
      if (choices.size() != 1) throw Error(ErrorKind::Usage, item + ": expected METRIC=VALUE, as psnr=40");
      bounds.push_back({choices[0].metric, parse_bound(item)});
      continue;
    }
    const Metric* found = nullptr;
    for (const Choice& choice : choices) {
      if (choice.metric->name == item.substr(0, equals)) found = choice.metric;
    }
    if (found == nullptr) throw Error(ErrorKind::Usage, item + ": this metric is not measured");
    bounds.push_back({found, parse_bound(item.substr(equals + 1))});
  }
  return bounds;
}

// A number with six digits; infinities are "inf" and "-inf".
std::string shown(double value) { return fmt::format("{:.6g}", value); }

std::string text_of(const Comparison& comparison) {
  std::string text = fmt::format("{} {}, {} × {}{}\n", comparison.count, comparison.count == 1 ? "image" : "images",
                                 comparison.width, comparison.height, comparison.are_same ? ", identical" : "");
  for (const Result& result : comparison.results) {
    text += fmt::format("  {:<14}{:>12} {:<13}", result.metric->name, shown(result.value), result.metric->unit);
    std::string more;
    if (result.values.size() > 1)
      more = fmt::format("worst {} in {}", shown(result.values[result.worst]), result.worst + 1);
    for (const metrics::Figure& figure : result.score.more) {
      more += fmt::format("{}{} {}", more.empty() ? "" : ", ", figure.name, shown(figure.value));
    }
    text += (more.empty() ? "" : " " + more);
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

/// JSON does not support infinities; they become the strings "inf" and "-inf".
Json json_number(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

Json::Array json_numbers(const std::vector<double>& values) {
  Json::Array out;
  for (const double value : values) out.push_back(json_number(value));
  return out;
}

Json json_of(const Result& result) {
  Json::Object row{{"value", json_number(result.value)},
                   {"unit", result.metric->unit},
                   {"better", result.metric->better == metrics::Better::Lower ? "lower" : "higher"}};
  if (result.values.size() > 1) {
    row.emplace_back("values", json_numbers(result.values));
    row.emplace_back("worst", static_cast<std::uint64_t>(result.worst));
  }
  Json::Object figures, curves;
  for (const metrics::Figure& figure : result.score.more) figures.emplace_back(figure.name, json_number(figure.value));
  for (const metrics::Curve& curve : result.score.curves) {
    curves.emplace_back(curve.name, Json::Object{{"x_label", curve.x_label},
                                                 {"y_label", curve.y_label},
                                                 {"x", json_numbers(curve.x)},
                                                 {"y", json_numbers(curve.y)}});
  }
  if (!figures.empty()) row.emplace_back("figures", std::move(figures));
  if (!curves.empty()) row.emplace_back("curves", std::move(curves));
  return row;
}

Json json_of(const Comparison& comparison, const std::string& reference, const std::string& test, bool is_good) {
  Json::Object rows;
  for (const Result& result : comparison.results) rows.emplace_back(result.metric->name, json_of(result));
  return Json::Object{{"format", "zoneplate-metrics"},
                      {"version", report_version},
                      {"reference", reference},
                      {"test", test},
                      {"images", static_cast<std::uint64_t>(comparison.count)},
                      {"width", comparison.width},
                      {"height", comparison.height},
                      {"identical", comparison.are_same},
                      {"passed", is_good},
                      {"metrics", std::move(rows)}};
}

/// The failure message if the images differ or a metric misses its threshold; else empty.
std::string shortfall(const Comparison& comparison, const std::vector<Bound>& bounds) {
  if (bounds.empty()) return comparison.are_same ? "" : "the images differ";
  std::string text;
  for (const Bound& bound : bounds) {
    for (const Result& result : comparison.results) {
      if (result.metric != bound.metric || metrics::is_as_good(*bound.metric, result.value, bound.value)) continue;
      text += fmt::format("{}{} is {}, the threshold is {} or {}", text.empty() ? "" : "; ", bound.metric->name,
                          shown(result.value), shown(bound.value),
                          bound.metric->better == metrics::Better::Lower ? "less" : "more");
    }
  }
  return text;
}

void save_map(const std::string& path, const Comparison& comparison) {
  for (const Result& result : comparison.results) {
    if (result.score.map.empty()) continue;
    return save_bytes(path, encode_png(metrics::paint_magma(result.score.map), {.has_alpha = false}));
  }
  throw Error(ErrorKind::Usage, "--map: none of these metrics has an error map");
}

// The catalogue of metrics at the end of the help.
std::string catalogue_text() {
  std::string text = "Metrics (--metric NAME:PARAMETER=VALUE,...; the default is all that are marked *):\n";
  for (const Metric& metric : metrics::metrics()) {
    text +=
        fmt::format("  {}{:<14}{} [{}]\n", metric.is_default ? '*' : ' ', metric.name, metric.summary, metric.source);
    for (const Param& param : metric.params) {
      text += fmt::format("   {:<14}  {}={} (default {:.6g})  {}\n", "", param.name, values_of(param), param.value,
                          param.meaning);
    }
  }
  return text;
}

Syntax make_syntax(MetricsArgs& args) {
  Syntax syntax{.verb = "metrics",
                .summary = "Measure the difference between images and a reference",
                .operands = "REFERENCE TEST",
                .examples =
                    "  zoneplate metrics reference.png test.png\n"
                    "  zoneplate metrics reference.png test.png --metric flip:ppd=30 --map error.png\n"
                    "  zoneplate metrics frames/a.####.png frames/b.####.png --metric psnr,flicker --json\n"
                    "  zoneplate metrics golden/ made/ --metric ssim --threshold 0.98\n",
                .notes =
                    "Operands are PNG, JPEG, WebP, HDR, EXR or PFM files, directories (paired by name) or sequences\n"
                    "(name.####.png, name.%04d.png).\n"
                    "\n"
                    "Exit codes, as of diff and cmp:\n"
                    "  0  without --threshold: the images are identical; with it: every metric reaches its threshold\n"
                    "  1  without --threshold: the images differ; with it: a metric misses its threshold\n"
                    "  2  an error: the images were not compared\n\n" +
                    catalogue_text()};
  syntax.options = {{"--metric", "NAME,...", "Metrics to measure, each NAME or NAME:PARAMETER=VALUE", "Options", true,
                     [&](auto& text) { args.metric_names = text; }},
                    {"--threshold", "VALUE", "Value that the metric must reach; for several metrics psnr=40,ssim=0.98",
                     "Options", true, [&](auto& text) { args.threshold = text; }},
                    {"--map", "FILE",
                     "Write the error map of the first metric that has one, as PNG; of several images, the worst one's",
                     "Options", true, [&](auto& text) { args.map_path = text; }},
                    {"--json", "", "Print one line of JSON, including measured curves", "Options", true,
                     [&](auto&) { args.prints_json = true; }},
                    {"--threads,-t", "N", "Threads at most; 0, the default: as many as affinity and CPU quota allow",
                     "Options", false, [&](auto& text) { args.threads = parse_whole(text, 0, 1024); }}};
  return syntax;
}

Comparison compare_operands(const std::string& reference, const std::string& test, const std::vector<Choice>& choices,
                            bool are_asked_for) {
  const metrics::PicturePairs pairs = metrics::pair_pictures(reference, test);
  const metrics::Comparands pictures{
      .count = pairs.reference.size(),
      .reference = [&](std::size_t i) { return metrics::load_picture(pairs.reference[i]); },
      .test = [&](std::size_t i) { return metrics::load_picture(pairs.test[i]); },
      .are_frames = metrics::are_frames(pairs.reference) && metrics::are_frames(pairs.test)};
  return metrics::compare(pictures, choices, are_asked_for ? metrics::Unfit::Refuse : metrics::Unfit::Leave);
}

void run(std::span<const std::string> arguments) {
  MetricsArgs args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.size() != 2) {
    throw Error(ErrorKind::Usage, "metrics takes two inputs: the reference and the images to compare");
  }
  const std::string reference = syntax.found_operands[0], test = syntax.found_operands[1];
  const std::vector<Choice> choices = choose(args.metric_names);
  const std::vector<Bound> bounds = parse_bounds(args.threshold, choices);

  Comparison comparison;
  with_threads(args.threads,
               [&] { comparison = compare_operands(reference, test, choices, !args.metric_names.empty()); });
  if (comparison.results.empty()) throw Error(ErrorKind::Input, test + ": expected the size of " + reference);
  if (!args.map_path.empty()) save_map(args.map_path, comparison);
  const std::string missing = shortfall(comparison, bounds);
  print(args.prints_json ? json_of(comparison, reference, test, missing.empty()).text() + '\n' : text_of(comparison));
  if (!missing.empty()) throw Difference(missing);
}

}  // namespace

void run_metrics(std::span<const std::string> arguments) {
  // Exit codes as those of diff and cmp: 1 for a difference, 2 for any error.
  try {
    run(arguments);
  } catch (const Error& error) {
    throw Error(ErrorKind::Usage, error.what());
  }
}

}  // namespace zoneplate::cli
