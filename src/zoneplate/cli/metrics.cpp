// SPDX-License-Identifier: Apache-2.0
// zoneplate metrics: the difference between images and a reference, by any of the catalogue's metrics.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/batch/manifest.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/common_options.h"
#include "zoneplate/cli/confined.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/evaluate/ignored_regions.h"
#include "zoneplate/evaluate/metrics/judge.h"
#include "zoneplate/evaluate/metrics/judgement_text.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/os/file.h"
#include "zoneplate/process/exr_layer.h"

namespace zoneplate::cli {
namespace {

/// The time in UTC, as ISO 8601 writes it.
std::string time_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", ::gmtime_r(&now, &parts))};
}

using metrics::Choice;
using metrics::Metric;

struct MetricsArgs {
  std::string metric_names, map_path, threshold, junit_path, report_path, renders_path, layer;
  std::optional<double> map_gain;  ///< none: the map alone, in magma
  bool judges_mean = false, allows_missing = false, is_quiet = false, prints_json = false;
  int threads = 0;
  std::optional<ProgressKind> progress;  ///< none: a bar on a terminal
  ReadingLimits limits;
  IgnoredInputs ignored;
};

std::vector<Choice> choose(const std::string& names) {
  if (names.empty()) return metrics::default_choices(metrics::metrics());
  std::vector<Choice> choices;
  if (names == "all") {
    for (const Metric& metric : metrics::metrics()) choices.push_back({&metric, Settings(metric.params)});
    return choices;
  }
  for (const std::string& name : split_specs(names)) {
    choices.push_back(metrics::choose_metric(metrics::metrics(), name));
  }
  return choices;
}

double parse_limit(const std::string& text) {
  if (text == "inf") return HUGE_VAL;
  if (text == "-inf") return -HUGE_VAL;
  return parse_number(text, -1e300, 1e300);
}

/// Parses a bound such as "psnr=40" or "mae.max=0.1"; "40" alone is of the only metric.
Bound parse_bound(const std::string& item, const std::vector<Choice>& choices) {
  const std::size_t equals = item.find('=');
  if (equals == std::string::npos) {
    if (choices.size() != 1) throw Error(ErrorKind::Usage, item + ": expected METRIC=VALUE, as psnr=40");
    return {choices[0].metric, "", parse_limit(item)};
  }
  const std::size_t dot = std::min(equals, item.find('.'));
  const std::string name = item.substr(0, dot);
  for (const Choice& choice : choices)
    if (choice.metric->name == name)
      return {choice.metric, dot < equals ? item.substr(dot + 1, equals - dot - 1) : "",
              parse_limit(item.substr(equals + 1))};
  throw Error(ErrorKind::Usage, item + ": this metric is not measured");
}

std::vector<Bound> parse_bounds(const std::string& text, const std::vector<Choice>& choices) {
  std::vector<Bound> bounds;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.size(), text.find(',', start));
    bounds.push_back(parse_bound(text.substr(start, end - start), choices));
    start = end + 1;
  }
  return bounds;
}

void save_map(const MetricsArgs& args, const Judgement& judgement, Delivery& out) {
  if (!judgement.worst_map) throw Error(ErrorKind::Usage, "--map: none of these metrics has an error map");
  const Rgba8Image image =
      args.map_gain ? paint_over(*judgement.worst_map, *judgement.worst_reference, static_cast<float>(*args.map_gain))
                    : metrics::paint_magma(*judgement.worst_map);
  out.save(args.map_path, encode_png(image, {.has_alpha = false}));
}

// The catalogue of metrics at the end of the help.
std::string catalogue_text() {
  std::string text =
      "Metrics (--metric NAME:PARAMETER=VALUE,...; the default is those marked *, and --metric all measures every "
      "one):\n";
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
  Syntax syntax{
      .verb = "metrics",
      .summary = "Measure the difference between images and a reference",
      .operands = "REFERENCE TEST",
      .examples =
          "  zoneplate metrics reference.png test.png\n"
          "  zoneplate metrics reference.png test.png --metric flip:ppd=30 --map error.png\n"
          "  zoneplate metrics frames/a.####.png frames/b.####.png --metric psnr,flicker --json\n"
          "  zoneplate metrics golden/ made/ --metric ssim --threshold 0.98 --report report.html\n"
          "  zoneplate metrics golden/ made/ --metric pixels:tolerance=2 --threshold 0.1 --junit junit.xml\n",
      .notes =
          "Operands are PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, BMP, TGA, HDR, EXR or PFM files, directories,\n"
          "sequences (name.####.png, name.%04d.png), animations (PNG, GIF, WebP) or videos (.mp4, .m4v, .mov, .mkv,\n"
          ".webm, .avi; ffmpeg decodes them), which are sequences of their frames.\n"
          "The images of two directories and their subfolders are paired by path, those of two sequences by\n"
          "number. Every pair passes or fails by itself: an image that is missing, new, unreadable or of another\n"
          "size fails, and the others are still compared. Figures that a metric reports besides its value have\n"
          "bounds too: mae.max=0.1.\n"
          "\n"
          "Images are identical if their files store the same: every bit of every channel, layer and part, and\n"
          "the same colour profile. Metrics measure one layer of an EXR (--layer): of two files with the same\n"
          "profile the codes, of others, which a line of the report names, the colours in sRGB, or in light of\n"
          "Rec.709 primaries. Those with alpha are measured over black and over white, and the worse value\n"
          "counts. NaN in any channel, and infinities in a colour, are counted and miss every threshold.\n"
          "\n"
          "Pixels that --ignore names have no part in the comparison: stored values, metrics, NaN and maps are those "
          "of\n"
          "the pixels that remain. For metrics with windows (ssim, ms_ssim, flip, edge_error, cvvdp) both images have\n"
          "the reference's pixels there, and the windows at remaining pixels count; a pixel of a coarser scale is "
          "ignored\n"
          "if all of its pixels are. Spectra and edge_response need the whole image, and are left out.\n"
          "\n"
          "Exit codes, as of diff and cmp:\n"
          "  0  without --threshold: the images are identical; with it: every image reaches it\n"
          "  1  an image failed: it differs, misses the threshold, has another size, is missing or unreadable\n"
          "  2  wrong usage\n"
          "  3  an operand does not exist or contains no image\n"
          "  4  a report cannot be written\n\n" +
          catalogue_text()};
  syntax.options = {
      {"--metric", "NAME,...", "Metrics to measure, each NAME or NAME:PARAMETER=VALUE, or all", "Options", true,
       [&](auto& text) { args.metric_names = text; }},
      {"--threshold", "VALUE", "Value that every image must reach; for several metrics psnr=40,ssim=0.98", "Options",
       true, [&](auto& text) { args.threshold = text; }},
      {"--aggregate", "HOW", "What --threshold judges: each image (default), or the mean of all", "Options", false,
       [&](auto& text) {
         args.judges_mean = parse_choice(text, {"each", "mean"}) == 1;
       }},
      {"--allow-missing", "", "Images and frames that only one side has do not fail", "Options", false,
       [&](auto&) { args.allows_missing = true; }},
      ignore_option(args.ignored, "Options"),
      layer_option(args.layer),
      {"--rendered", "FILE.jsonl",
       "Lines that render printed while it made the folder TEST: an image that it could not make fails with the cause",
       "Options", true, [&](auto& text) { args.renders_path = text; }},
      {"--map", "FILE",
       "Write the error map of the first metric that has one, as PNG; of several images, the worst one's", "Reports",
       true, [&](auto& text) { args.map_path = text; }},
      {"--map-gain", "GAIN", "Multiply the errors of the map, and draw it over the reference in grey", "Reports", false,
       [&](auto& text) { args.map_gain = parse_number(text, 0.001, 1e6); }},
      {"--report", "FILE.html",
       "Write a page for a browser: all values, and the images and error maps of failed pairs and of sequences",
       "Reports", true, [&](auto& text) { args.report_path = text; }},
      {"--junit", "FILE.xml", "Write JUnit XML, one test case for each image", "Reports", true,
       [&](auto& text) { args.junit_path = text; }},
      {"--json", "", "Print one line of JSON, with the values of each image and measured curves", "Reports", true,
       [&](auto&) { args.prints_json = true; }},
      {"--quiet,-q", "", "Print nothing but errors; the exit code is the result", "Reports", false,
       [&](auto&) { args.is_quiet = true; }},
      {"--progress", "KIND", "bar, json or none; default: a bar on a terminal", "Reports", false,
       [&](auto& text) { args.progress = parse_progress(text); }},
      {"--threads,-t", "N", "Threads at most; 0, the default: as many as affinity and CPU quota allow", "Options",
       false, [&](auto& text) { args.threads = parse_whole(text, 0, 1024); }}};
  for (Option& option : limit_options(args.limits)) syntax.options.push_back(std::move(option));
  return syntax;
}

/// The images that render could not make, from the lines that it printed (cli/render/batch.h), by their paths within
/// the folder `test`.
FailedRenders read_failed_renders(const std::string& path, const std::string& test, const LoadLimits& limits) {
  FailedRenders out;
  if (path.empty()) return out;
  namespace fs = std::filesystem;
  const Manifest lines(path, limits.memory / 2);
  for (std::uint64_t i = 0; i < lines.size(); ++i) {
    const std::string_view text = lines.text(i);
    ImportBudget budget(lines.place(i), limits);
    const JsonValue line = parse_json({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, budget);
    const JsonView view(line, lines.place(i));
    if (view.text("format") != "zoneplate-render") view.fail("is no line of zoneplate render");
    if (view.text("status") != "failed") continue;
    const std::string output = view.text("not_written");
    const fs::path name =
        output.empty() ? fs::path() : fs::weakly_canonical(output).lexically_relative(fs::weakly_canonical(test));
    if (name.empty() || name == "." || *name.begin() == "..")
      view.fail(fmt::format("failed, and would have made no image in {}: {}", test, view.text("error")));
    out.emplace(name.string(), view.text("error"));
  }
  return out;
}

/// The images of an operand. With --rendered, a folder may have none: before the first references are accepted, and if
/// render made none. Every image of the other folder then fails.
metrics::PictureSet open_operand(const std::string& operand, const MetricsArgs& args) {
  if (!args.renders_path.empty() && std::filesystem::is_directory(operand) && !metrics::has_pictures(operand))
    return {.is_directory = true};
  return metrics::open_pictures(operand, video_limits(args.limits));
}

/// The same images, or the frames of the only one, each of which is decoded within the limits, and of EXRs the layer
/// that is meant.
metrics::PictureSet within_limits(metrics::PictureSet set, const std::string& layer, Delivery& out) {
  if (set.files.size() == 1)
    out.read(set.files[0], [&] { set = metrics::with_frames(std::move(set), out.limits().pixels); });
  set.open = [open = std::move(set.open), layer](std::size_t i) {
    metrics::ImageFile file = open(i);
    file.exr.layer = layer;
    return file;
  };
  set.decode = [&out](const metrics::ImageFile& file) {
    metrics::Picture picture;
    out.read(file.name, [&] { picture = metrics::decode_file(file, out.limits().pixels); });
    tell_layer(file, out);
    out.warn_of_flaw(picture.flaw), out.warn_of_flaw(picture.color_flaw);
    return picture;
  };
  return set;
}

/// Runs in the confined process.
void deliver(const MetricsArgs& args, const Judgement& judgement, const ComparedPaths& paths, Delivery& out) {
  if (!args.map_path.empty()) save_map(args, judgement, out);
  if (!args.report_path.empty()) out.save(args.report_path, html_of(judgement, paths));
  if (!args.junit_path.empty()) out.save(args.junit_path, junit_of(judgement, paths, time_now()));
  if (!args.is_quiet) out.print(args.prints_json ? json_of(judgement, paths).text() + '\n' : text_of(judgement));
  if (!judgement.passed()) throw Difference(failure_of(judgement));
}

}  // namespace

void run_metrics(std::span<const std::string> arguments) {
  MetricsArgs args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.size() != 2) {
    throw Error(ErrorKind::Usage, "metrics takes two inputs: the reference and the images to compare");
  }
  const ComparedPaths paths{syntax.found_operands[0], syntax.found_operands[1]};
  const std::vector<Choice> choices = choose(args.metric_names);
  const bool are_named = !args.metric_names.empty() && args.metric_names != "all";
  Verdicts verdicts{.bounds = parse_bounds(args.threshold, choices),
                    .judges_mean = args.judges_mean,
                    .allows_unpaired = args.allows_missing,
                    .refuses_unfit = are_named,
                    .ignored_texts = args.ignored.texts};
  if (args.judges_mean && verdicts.bounds.empty()) throw Error(ErrorKind::Usage, "--aggregate: requires --threshold");
  if (args.map_gain && args.map_path.empty()) throw Error(ErrorKind::Usage, "--map-gain: requires --map");
  for (const std::string& path : {args.map_path, args.report_path, args.junit_path})
    if (!path.empty()) check_savable(path);

  with_threads(args.threads, [&] {
    const metrics::PictureSet reference = open_operand(paths.reference, args), test = open_operand(paths.test, args);
    verdicts.failed_renders = read_failed_renders(args.renders_path, paths.test, args.limits.load);
    if (!args.renders_path.empty() && !test.is_directory)
      throw Error(ErrorKind::Usage, "--rendered: TEST is no folder");
    if (reference.names.empty() && test.names.empty() && verdicts.failed_renders.empty())
      throw Error(ErrorKind::Input, fmt::format("{} and {}: hold no image", paths.reference, paths.test));
    if (reference.is_directory != test.is_directory)
      throw Error(ErrorKind::Usage, fmt::format("{}: expected {} as the reference", paths.test,
                                                reference.is_directory ? "a directory" : "a file"));
    ConfinedRun run{.name = paths.test, .limits = args.limits, .readable = reference.files};
    run.readable.insert(run.readable.end(), test.files.begin(), test.files.end());
    run.readable.insert(run.readable.end(), args.ignored.masks.begin(), args.ignored.masks.end());
    run.outputs = {args.map_path, args.report_path, args.junit_path};
    Progress progress(args.is_quiet ? ProgressKind::None : args.progress ? *args.progress : parse_progress("auto"));
    run.progress = &progress;
    run_confined(run, [&](Delivery& out) {
      verdicts.ignored = read_ignored(args.ignored, out);
      const metrics::PictureSet references = within_limits(reference, args.layer, out),
                                tests = within_limits(test, args.layer, out);
      if (!args.layer.empty())
        for (const metrics::PictureSet* set : {&references, &tests})
          if (!set->names.empty()) tell_layer(set->open(0), out);
      const Judgement judgement = judge(references, tests, choices, verdicts, !args.report_path.empty(),
                                        [&](double done) { out.progress("compare", done); });
      // Of two files, not of folders that hold one image each.
      const bool is_pair = !reference.is_directory && judgement.items.size() == 1;
      if (is_pair && judgement.items[0].outcome == PairOutcome::Unreadable)
        throw Error(ErrorKind::Input, judgement.items[0].message);
      deliver(args, judgement, paths, out);
    });
  });
}

}  // namespace zoneplate::cli
