// SPDX-License-Identifier: Apache-2.0
// zoneplate compare: measures antialiasing methods on scenes against one reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/compare/page.h"
#include "zoneplate/cli/compare/pictures.h"
#include "zoneplate/cli/output_paths.h"
#include "zoneplate/cli/render/args.h"
#include "zoneplate/cli/render/environment_file.h"
#include "zoneplate/cli/render/film.h"
#include "zoneplate/cli/render/picture.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/sequence.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

struct CompareArgs {
  RenderArgs render;  ///< size, view, lights, tone mapping, limits: the options of `zoneplate render`
  std::vector<std::string> scenes, command;
  std::string methods = "all", reference, page, metrics;
  bool replaces = false;  ///< an earlier comparison in the folder of the output

  /// The file by which save_folder recognises the folder that it replaces; empty: none.
  std::string replaced() const { return replaces ? "compare.json" : ""; }
  int turns = 3, frames = 1;
};

constexpr const char* examples =
    "  zoneplate compare teapot --aa none,fxaa,smaa,msaa:n=4,ssaa:n=4 -o teapot-compared\n"
    "  zoneplate compare wires stars foliage --aa all --reference ssaa:n=16 -o compared\n"
    "  zoneplate compare all --aa all -o everything         all scenes that show a class of artifacts\n"
    "  zoneplate compare passing-fence disocclusion --frames 24 --aa none,taa,oracle-taa -o films\n"
    "  zoneplate compare wires --aa none,fxaa,msaa:n=8 --html wires.html     only the page, for a browser\n"
    "  zoneplate compare chair.glb --aa msaa:n=8,ssaa:pattern=halton,samples=64 --reference chair-reference.png -o "
    "chair\n";

constexpr const char* notes =
    "SCENE is a file or a built-in scene; `all` selects every built-in scene that shows a class of artifacts. LIST is\n"
    "a comma-separated list of methods, or `all`: every method with its default and with its usual parameters.\n"
    "\n"
    "The folder DIR must not exist, or with --force be that of an earlier comparison, which it replaces; it is\n"
    "created completely or not at all, and no other file changes:\n"
    "  compare.txt, compare.csv, compare.json   the results; the JSON contains all of them, and a version number\n"
    "  compare.md                               all methods on all scenes as a Markdown table\n"
    "  cost.svg                                 mean error against mean cost, with the Pareto front\n"
    "  SCENE/reference.png, SCENE/METHOD.png    the images; METHOD.error.png: FLIP error maps; METHOD.worst.png: the\n"
    "                                           regions of greatest error, enlarged 8 times\n"
    "  SCENE/crops.png, SCENE/cost.svg          the same region by every method; error against cost\n"
    "With --frames, every method renders one sequence of the scene's animation, 24 frames per second; metrics are "
    "those\n"
    "of all frames, images are the last frame, and in addition:\n"
    "  SCENE/METHOD.film.png                    the frames as an animated PNG, those of the reference too\n"
    "  SCENE/METHOD.difference.png              8 times the difference from the reference, about grey, animated\n"
    "  SCENE/METHOD.slice.png                   the middle row of all frames, time running downwards\n"
    "\n"
    "Times are the minimum of several turns, from the scene in memory to the 8-bit image; stage times belong to the\n"
    "fastest turn. Compare only times of the same run. A method whose turns take more than 1.5 s gets fewer turns,\n"
    "as the report states. The cost of the reference is printed next to its name.\n"
    "Memory is the increase of the process's resident memory in the first turn. All other results are the same on\n"
    "every machine.\n";

/// The applicable options of `render`, and the verb's own.
Syntax compare_syntax(CompareArgs& args) {
  Syntax syntax{.verb = "compare",
                .summary = "Render scenes with many antialiasing methods and measure each against a reference",
                .operands = "SCENE... --aa LIST -o DIR",
                .examples = examples,
                .notes = notes};
  const std::string group = "Comparison";
  syntax.options = {
      {"--output,-o", "DIR", "Folder to create", group, true, [&](auto& text) { args.render.output = text; }},
      {"--force", "", "Replace DIR if it is the output of an earlier comparison", group, false,
       [&](auto&) { args.replaces = true; }},
      {"--html", "FILE.html",
       "Write one page with all images and frames, for a browser: linked zoom, differences, error maps, values of "
       "pixels",
       group, true, [&](auto& text) { args.page = text; }},
      {"--anti-aliasing,--aa", "LIST",
       "Methods, for example none,msaa:n=4 (zoneplate list methods), or all; default all", group, true,
       [&](auto& text) { args.methods = text; }},
      {"--reference", "REF",
       "Reference: a method (analytic, converged, ssaa:n=16, ...) or an image file; default converged", group, true,
       [&](auto& text) { args.reference = text; }},
      {"--metric", "LIST",
       "Metrics (zoneplate metrics --help), default psnr,ssim,flip,edge_error, or of sequences "
       "psnr,tpsnr,flicker; flip is always included",
       group, false, [&](auto& text) { args.metrics = text; }},
      {"--frames", "N", "Frames of a sequence that each method renders; default 1, a still image", group, false,
       [&](auto& text) { args.frames = parse_whole(text, 1, 1000); }},
      {"--turns", "N", "Frames rendered by each method, of which the fastest counts; default 3", group, false,
       [&](auto& text) { args.turns = parse_whole(text, 1, 1000); }}};
  constexpr std::string_view left_out[] = {
      "--output",       "--anti-aliasing",   "--no-background",   "--crop",      "--aov",         "--dither",
      "--bit-depth",    "--output-format",   "--preset",          "--no-config", "--dry-run",     "--jpeg-quality",
      "--webp-quality", "--png-compression", "--exr-compression", "--upscale",   "--render-scale"};
  for (Option& option : render_syntax(args.render).options) {
    const std::string first = option.names.substr(0, option.names.find(','));
    if (option.group == "Sequences" || option.group == "Batches") continue;
    if (std::ranges::find(left_out, first) != std::end(left_out)) continue;
    if (first == "--resolution") option.meaning = "Size in pixels, 640,480 or 640x480; default 640,480";
    if (first == "--json") option.meaning = "Print the JSON report instead of the tables";
    syntax.options.push_back(std::move(option));
  }
  return syntax;
}

bool is_method(std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  return std::ranges::any_of(antialias::methods(), [&](const Method& m) { return m.name == name; });
}

/// Every method with its defaults and all of its variants.
std::vector<std::string> all_methods() {
  std::vector<std::string> out;
  for (const Method& m : antialias::methods()) {
    if (m.is_reference) continue;
    out.emplace_back(m.name);
    for (const std::string_view v : m.variants) out.push_back(fmt::format("{}:{}", m.name, v));
  }
  return out;
}

std::vector<std::string> methods_of(const std::string& text) {
  std::vector<std::string> out;
  for (const std::string& item : split_specs(text)) {
    const std::vector<std::string> own = item == "all" ? all_methods() : std::vector{item};
    for (const std::string& m : own) {
      upscale::make_method(m);  // throws if it is invalid
      if (std::ranges::find(out, m) == out.end()) out.push_back(m);
    }
  }
  return out;
}

/// The reference that is valid for all scenes. `analytic` is exact for edges, but it shades each surface of a pixel
/// once and tests alpha on a grid, so that textures, highlights and alpha tests are aliased as in the tested methods.
constexpr const char* best_reference = "converged";

std::vector<metrics::Choice> metrics_of(const std::string& text, int frames) {
  std::vector<metrics::Choice> out;
  const char* const usual = frames > 1 ? "psnr,tpsnr,flicker" : "psnr,ssim,flip,edge_error";
  for (const std::string& item : split_specs(text.empty() ? usual : text)) {
    out.push_back(metrics::choose_metric(metrics::metrics(), item));
    const metrics::Metric& metric = *out.back().metric;
    const int least = metric.starts_short ? std::min(metric.frames, 2) : metric.frames;
    if (least > frames)
      throw Error(ErrorKind::Usage,
                  fmt::format("--metric {}: it measures sequences: give --frames {} or more", metric.name, least));
  }
  if (std::ranges::none_of(out, [](const auto& c) { return c.metric->name == "flip"; }))
    out.push_back(metrics::choose_metric(metrics::metrics(), "flip"));
  return out;
}

TrialOptions trial_options(const CompareArgs& args) {
  TrialOptions out{
      .methods = methods_of(args.methods), .turns = args.turns, .metrics = metrics_of(args.metrics, args.frames)};
  out.reference = args.reference.empty() ? best_reference : args.reference;
  std::error_code ignored;
  if (is_method(out.reference))
    upscale::make_method(out.reference);
  else if (std::filesystem::exists(out.reference, ignored))
    out.is_reference_file = true;
  else if (out.reference.find_first_of("./") != std::string::npos)
    throw Error(ErrorKind::Input, out.reference + ": no such file");
  else
    upscale::make_method(out.reference);  // throws with the list of methods
  if (out.is_reference_file && args.frames > 1)
    throw Error(ErrorKind::Usage, "--reference: a sequence needs a method as reference, not an image");
  if (out.is_reference_file && args.scenes.size() > 1)
    throw Error(ErrorKind::Usage, fmt::format("--reference {}: one image is a reference for one scene, not for {}",
                                              out.reference, args.scenes.size()));
  return out;
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::vector<std::uint8_t> png(const Rgba8Image& image) {
  return encode_png(image, {.has_alpha = false, .may_be_indexed = true});
}

/// The film `name`, its slice in time and, where there is a reference, the difference from it.
void add_film(const std::string& name, const std::vector<Rgba8Image>& frames, const std::vector<Rgba8Image>& reference,
              std::vector<OutputFile>& files) {
  const AnimationFormat format = film_format(trial_frame_rate);
  files.push_back({name + ".film.png", encode_apng({format, frames})});
  files.push_back({name + ".slice.png", png(slice_in_time(frames, frames[0].height() / 2))});
  if (reference.empty()) return;
  files.push_back({name + ".difference.png", encode_apng({format, difference_film(reference, frames)})});
}

void add_files(const SceneTrials& scene, std::vector<OutputFile>& files) {
  files.push_back({scene.name + "/reference.png", png(scene.reference_picture)});
  for (const Trial& t : scene.trials) {
    const TrialFiles names = files_of(scene, t);
    files.push_back({names.picture, png(t.picture)});
    files.push_back({names.error_map, png(metrics::paint_magma(t.error_map))});
    files.push_back({names.worst, png(worst_picture(scene, t))});
    if (!t.film.empty()) add_film(scene.name + '/' + file_name_of(t.method), t.film, scene.reference_film, files);
  }
  if (!scene.reference_film.empty()) add_film(scene.name + "/reference", scene.reference_film, {}, files);
  files.push_back({scene.name + "/crops.png", png(crops_picture(scene))});
  files.push_back({scene.name + "/cost.svg", bytes_of(plot_svg(cost_plot(scene)))});
}

/// Converts "models/chair.glb" and "wheel:spokes=7" to unique names of folders.
std::string folder_name(const std::string& scene, const std::vector<SceneTrials>& before) {
  const std::string stem = is_builtin_scene(scene) ? scene : std::filesystem::path(scene).stem().string();
  const std::string own = file_name_of(stem);
  std::string name = own.empty() ? "scene" : own;
  const auto is_taken = [&] {
    return std::ranges::any_of(before, [&](const SceneTrials& s) { return s.name == name; });
  };
  for (int n = 2; is_taken(); ++n) name = fmt::format("{}-{}", own, n);
  return name;
}

/// The frames of a scene: of its first animation, or at rest if it has none.
Sequence sequence_of(const CompareArgs& args, SceneSource& source) {
  SceneChoice choice;
  if (!source.load({}).animations.empty()) choice.animation = 0;
  const auto at = [&args, &source, choice](double seconds) mutable {
    choice.time = seconds;
    Scene scene = source.load(choice);
    set_look(args.render, scene);
    return scene;
  };
  return {{at, at, [&source, choice] { return source.key_times(choice); }},
          args.render.mips,
          {.rate = trial_frame_rate, .duration = args.frames / trial_frame_rate}};
}

SceneTrials compare_scene(const CompareArgs& args, const std::string& name, const TrialOptions& options,
                          const TrialProgress& progress) {
  Scene scene = load_scene(name, args.render.load);
  View view = args.render.view;
  view.up = args.render.up.value_or(scene.up);
  if (is_builtin_scene(name) && !scene.cameras.empty() && !view.index && !view.position) view.index = 0;
  RenderSettings settings{.options = args.render.options};
  settings.options.display = args.render.display;
  settings.options.display.background = args.render.background.value_or(default_background);
  const float aspect = static_cast<float>(settings.options.width) / static_cast<float>(settings.options.height);
  const Camera camera = choose_camera(scene, view, aspect);
  settings.options.display.mapping = set_look(args.render, scene);
  const PreparedScene prepared(std::move(scene), args.render.mips);
  if (args.render.meters_exposure) settings.options.display.exposure = metered_exposure(prepared, camera, args.render);
  TrialSetup setup{prepared, camera, settings, args.frames};
  std::optional<SceneSource> source;
  std::optional<Sequence> sequence;
  if (args.frames > 1) {
    source.emplace(name, args.render.load);
    sequence.emplace(sequence_of(args, *source));
    sequence->set_view(view, aspect);
    setup.view = [&](int frame) { return sequence->view(frame); };
  }
  SceneTrials out = run_trials(setup, options, progress);
  out.scene = name;
  if (const BuiltinScene* listed = find_builtin_scene(name))
    out.failure = listed->failure, out.complaint = listed->complaint;
  if (args.render.verbosity != Verbosity::Quiet)
    for (const std::string& warning : prepared.scene().warnings) say_warning(warning);
  return out;
}

std::vector<std::string> scenes_of(const std::vector<std::string>& operands) {
  std::vector<std::string> out;
  for (const std::string& operand : operands) {
    if (operand != "all") {
      out.push_back(operand);
      continue;
    }
    for (const BuiltinScene& scene : builtin_scenes())
      if (!scene.failure.empty()) out.push_back(scene.name);
  }
  return out;
}

/// Reports an invalid scene name before the first scene is drawn.
void check_scenes(const CompareArgs& args) {
  std::error_code ignored;
  for (const std::string& name : args.scenes) {
    if (args.render.load.format.empty() && check_builtin_scene(name)) continue;
    if (name != "-" && !std::filesystem::exists(name, ignored))
      load_scene(name, args.render.load);  // throws with the cause
  }
}

/// The files and the text that a run writes.
struct Comparison {
  std::vector<OutputFile> files;
  std::string text, json, page;
};

Comparison compare_all(const CompareArgs& args, const TrialOptions& options) {
  // Throws before the work if plots cannot be drawn.
  if (!args.render.output.empty()) static_cast<void>(plot_svg({.x = {"x", 0, 1}, .y = {"y", 0, 1}}));
  Progress progress(args.render.progress ? *args.render.progress : parse_progress("auto"));
  std::vector<SceneTrials> scenes;
  std::vector<OutputFile> files;
  ComparisonPage page;
  const double steps = static_cast<double>(args.scenes.size() * (options.methods.size() + 2));
  double done = 0;
  for (const std::string& name : args.scenes) {
    SceneTrials scene = compare_scene(args, name, options, [&](const std::string& method) {
      const std::string stage = name + ", " + method;
      progress.begin(stage, done / steps);
      const double begin = done++ / steps;
      return percents(begin, done / steps, [&progress, stage](double now) { progress.begin(stage, now); });
    });
    scene.name = folder_name(name, scenes);
    progress.begin(name + ", images", done++ / steps);
    if (!args.render.output.empty()) add_files(scene, files);
    if (!args.page.empty()) page.add(scene);
    // Frees images that are already encoded.
    for (Trial& t : scene.trials) t.picture = {}, t.error_map = {}, t.film = {};
    scene.reference_film = {};
    scenes.push_back(std::move(scene));
  }
  Comparison out{.files = std::move(files),
                 .text = report_text(scenes),
                 .json = report_json(scenes, args.command).indented() + '\n',
                 .page = args.page.empty() ? "" : page.text(scenes)};
  if (args.render.output.empty()) return out;
  const Plot cost = scenes.size() == 1 ? cost_plot(scenes[0]) : cost_plot(means_of(scenes));
  out.files.push_back({"cost.svg", bytes_of(plot_svg(cost, {.width = 960, .height = 600}))});
  out.files.push_back({"compare.txt", bytes_of(out.text)});
  out.files.push_back({"compare.md", bytes_of(report_markdown(scenes))});
  out.files.push_back({"compare.csv", bytes_of(report_csv(scenes))});
  out.files.push_back({"compare.json", bytes_of(out.json)});
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
  check_environment(args.render);
  const TrialOptions options = trial_options(args);
  if (!args.page.empty()) check_savable(args.page);
  if (args.page.empty() || !args.render.output.empty()) check_output_folder(args.render.output, args.replaced());
  check_scenes(args);
  if (args.render.verbosity == Verbosity::Quiet && !args.render.progress) args.render.progress = ProgressKind::None;
  Comparison made;
  Environments environments;
  with_isa(args.render.isa, [&] {
    with_threads(args.render.threads, [&] {
      environments.complete(args.render);
      made = compare_all(args, options);
    });
  });
  if (!args.render.output.empty())
    save_folder(args.render.output, made.files, args.replaced());  // without other threads, as it requires
  if (!args.page.empty()) save_bytes(args.page, bytes_of(made.page));
  if (args.render.verbosity != Verbosity::Quiet || args.render.prints_json)
    print_report(args.render.prints_json ? made.json : made.text);
}

}  // namespace zoneplate::cli
