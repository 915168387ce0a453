// zoneplate compare: scenes under many antialiasing methods, each judged against one reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/compare/pictures.h"
#include "zoneplate/cli/output_paths.h"
#include "zoneplate/cli/render/args.h"
#include "zoneplate/cli/render/picture.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::cli {
namespace {

struct CompareArgs {
  RenderArgs render;  ///< size, view, light, tone mapping, limits: as `zoneplate render` takes them
  std::vector<std::string> scenes, command;
  std::string methods = "all", reference, metrics = "psnr,ssim,flip,edge_error";
  int turns = 3;
};

constexpr const char* examples =
    "  zoneplate compare teapot --aa none,fxaa,smaa,msaa:n=4,ssaa:n=4 -o teapot-compared\n"
    "  zoneplate compare wires stars foliage --aa all --reference ssaa:n=16 -o compared\n"
    "  zoneplate compare all --aa all -o everything         every scene that shows a class of failure\n"
    "  zoneplate compare chair.glb --aa msaa:n=8,ssaa:pattern=halton,samples=64 --reference truth.png -o chair\n";

constexpr const char* notes =
    "SCENE is a file or a built-in scene; `all` stands for every built-in scene with a class of failure. LIST is\n"
    "methods at commas, or `all`: every method at its defaults and with the parameters that it is known by.\n"
    "\n"
    "The folder DIR must not exist; it is made whole or not at all, and nothing else is replaced or removed:\n"
    "  compare.txt, compare.csv, compare.json   the figures; the JSON holds everything, and its version\n"
    "  compare.md                               all methods on all scenes as a table for a page\n"
    "  cost.svg                                 error and cost of the means, the Pareto front marked\n"
    "  SCENE/reference.png, SCENE/METHOD.png    the pictures, METHOD.error.png their FLIP, METHOD.worst.png the worst\n"
    "                                           places 8 times enlarged\n"
    "  SCENE/crops.png, SCENE/cost.svg          one place under every method; error and cost\n"
    "\n"
    "A time is the least of several turns, from the scene in memory to its codes, and the times of its stages are\n"
    "those of the same turn; compare methods of one run only. A method whose turns take more than 1.5 s gets fewer,\n"
    "which the report says. The reference's cost stands beside its name.\n"
    "Memory is the rise of the process' resident memory in the first turn. Everything else is the same on every\n"
    "machine.\n";

/// The options of `render` that have a meaning here, and the verb's own.
Syntax compare_syntax(CompareArgs& args) {
  Syntax syntax{.verb = "compare",
                .summary = "Render scenes by many antialiasing methods and judge each against a reference",
                .operands = "SCENE... --aa LIST -o DIR",
                .examples = examples,
                .notes = notes};
  const std::string group = "Comparison";
  syntax.options = {
      {"--output,-o", "DIR", "The folder to be made", group, true, [&](auto& text) { args.render.output = text; }},
      {"--anti-aliasing,--aa", "LIST", "Methods, as none,msaa:n=4 (zoneplate list methods), or all; default all", group,
       true, [&](auto& text) { args.methods = text; }},
      {"--reference", "TRUTH", "A method (analytic, converged, ssaa:n=16, ...) or a picture's file; default converged",
       group, true, [&](auto& text) { args.reference = text; }},
      {"--metric", "LIST", "Metrics (zoneplate metrics --help); flip is always among them", group, false,
       [&](auto& text) { args.metrics = text; }},
      {"--turns", "N", "Frames drawn by each method, of which the fastest counts; default 3", group, false,
       [&](auto& text) { args.turns = parse_whole(text, 1, 1000); }}};
  constexpr std::string_view left_out[] = {"--output", "--anti-aliasing", "--no-background", "--crop", "--aov"};
  for (Option& option : render_syntax(args.render).options) {
    const std::string first = option.names.substr(0, option.names.find(','));
    if (std::ranges::find(left_out, first) != std::end(left_out)) continue;
    if (first == "--resolution") option.meaning = "Size in pixels, 640,480 or 640x480; default 640,480";
    if (first == "--json") option.meaning = "Print the JSON in place of the tables";
    syntax.options.push_back(std::move(option));
  }
  return syntax;
}

bool is_method(std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  return std::ranges::any_of(antialias::methods(), [&](const Method& m) { return m.name == name; });
}

/// Every method at its defaults, and as it names its variants.
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
      make_resolver(antialias::methods(), m);  // says what is wrong with it
      if (std::ranges::find(out, m) == out.end()) out.push_back(m);
    }
  }
  return out;
}

/// The reference that is right for every scene. `analytic` is exact for edges, but it shades each surface of a pixel
/// once and tests alpha on a grid, so textures, highlights and masks alias in it as they do in the methods it would
/// judge.
constexpr const char* best_reference = "converged";

std::vector<metrics::Choice> metrics_of(const std::string& text) {
  std::vector<metrics::Choice> out;
  for (const std::string& item : split_specs(text)) out.push_back(metrics::choose_metric(metrics::metrics(), item));
  if (std::ranges::none_of(out, [](const auto& c) { return c.metric->name == "flip"; }))
    out.push_back(metrics::choose_metric(metrics::metrics(), "flip"));
  return out;
}

TrialOptions trial_options(const CompareArgs& args) {
  TrialOptions out{.methods = methods_of(args.methods), .turns = args.turns, .metrics = metrics_of(args.metrics)};
  out.reference = args.reference.empty() ? best_reference : args.reference;
  std::error_code ignored;
  if (is_method(out.reference))
    make_resolver(antialias::methods(), out.reference);
  else if (std::filesystem::exists(out.reference, ignored))
    out.is_reference_file = true;
  else if (out.reference.find_first_of("./") != std::string::npos)
    throw Error(ErrorKind::Input, out.reference + ": no such file");
  else
    make_resolver(antialias::methods(), out.reference);  // names the methods that there are
  if (out.is_reference_file && args.scenes.size() > 1)
    throw Error(ErrorKind::Usage, fmt::format("--reference {}: one image is the reference of one scene, not of {}",
                                              out.reference, args.scenes.size()));
  return out;
}

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::vector<std::uint8_t> png(const Rgba8Image& image) {
  return encode_png(image, {.has_alpha = false, .may_be_indexed = true});
}

void add_files(const SceneTrials& scene, std::vector<OutputFile>& files) {
  files.push_back({scene.name + "/reference.png", png(scene.reference_picture)});
  for (const Trial& t : scene.trials) {
    const TrialFiles names = files_of(scene, t);
    files.push_back({names.picture, png(t.picture)});
    files.push_back({names.error_map, png(metrics::paint_magma(t.error_map))});
    files.push_back({names.worst, png(worst_picture(scene, t))});
  }
  files.push_back({scene.name + "/crops.png", png(crops_picture(scene))});
  files.push_back({scene.name + "/cost.svg", bytes_of(plot_svg(cost_plot(scene)))});
}

/// "models/chair.glb" and "wheel:spokes=7" as names of folders, each once.
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

SceneTrials compare_scene(const CompareArgs& args, const std::string& name, const TrialOptions& options,
                          const std::function<void(const std::string&)>& tell) {
  Scene scene = load_scene(name, args.render.load);
  View view = args.render.view;
  view.up = args.render.up.value_or(scene.up);
  if (is_builtin_scene(name) && !scene.cameras.empty() && !view.index && !view.position) view.index = 0;
  RenderSettings settings{.options = args.render.options};
  settings.options.display = args.render.display;
  settings.options.display.background = args.render.background.value_or(default_background);
  const Camera camera = choose_camera(
      scene, view, static_cast<float>(settings.options.width) / static_cast<float>(settings.options.height));
  set_look(args.render, scene);
  const PreparedScene prepared(std::move(scene), args.render.raw_colors);
  SceneTrials out = run_trials({prepared, camera, settings}, options, tell);
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

/// Says what is wrong with the name of any scene before the first is drawn.
void check_scenes(const CompareArgs& args) {
  std::error_code ignored;
  for (const std::string& name : args.scenes) {
    if (args.render.load.format.empty() && check_builtin_scene(name)) continue;
    if (name != "-" && !std::filesystem::exists(name, ignored))
      load_scene(name, args.render.load);  // fails, and knows how to say it
  }
}

/// What a run writes into its folder, and prints.
struct Comparison {
  std::vector<OutputFile> files;
  std::string text, json;
};

Comparison compare_all(const CompareArgs& args, const TrialOptions& options) {
  static_cast<void>(
      plot_svg({.x = {"x", 0, 1}, .y = {"y", 0, 1}}));  // fails at once where plots cannot be drawn, not after the work
  Progress progress(args.render.progress ? *args.render.progress : parse_progress("auto"));
  std::vector<SceneTrials> scenes;
  std::vector<OutputFile> files;
  const double steps = static_cast<double>(args.scenes.size() * (options.methods.size() + 2));
  double done = 0;
  for (const std::string& name : args.scenes) {
    SceneTrials scene = compare_scene(
        args, name, options, [&](const std::string& method) { progress.begin(name + ", " + method, done++ / steps); });
    scene.name = folder_name(name, scenes);
    progress.begin(name + ", pictures", done++ / steps);
    add_files(scene, files);
    // What is written already need not be kept.
    for (Trial& t : scene.trials) t.picture = {}, t.error_map = {};
    scenes.push_back(std::move(scene));
  }
  std::string text = report_text(scenes);
  std::string json = report_json(scenes, args.command).indented() + '\n';
  const Plot cost = scenes.size() == 1 ? cost_plot(scenes[0]) : cost_plot(means_of(scenes));
  files.push_back({"cost.svg", bytes_of(plot_svg(cost, {.width = 960, .height = 600}))});
  files.push_back({"compare.txt", bytes_of(text)});
  files.push_back({"compare.md", bytes_of(report_markdown(scenes))});
  files.push_back({"compare.csv", bytes_of(report_csv(scenes))});
  files.push_back({"compare.json", bytes_of(json)});
  return {std::move(files), std::move(text), std::move(json)};
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
  const TrialOptions options = trial_options(args);
  check_output_folder(args.render.output);
  check_scenes(args);
  if (args.render.verbosity == Verbosity::Quiet && !args.render.progress) args.render.progress = ProgressKind::None;
  Comparison made;
  with_isa(args.render.isa, [&] { with_threads(args.render.threads, [&] { made = compare_all(args, options); }); });
  save_folder(args.render.output, made.files);  // without other threads, as it requires
  if (args.render.verbosity != Verbosity::Quiet || args.render.wants_json)
    print(args.render.wants_json ? made.json : made.text);
}

}  // namespace zoneplate::cli
