// SPDX-License-Identifier: Apache-2.0
// zoneplate compare: measures antialiasing methods on scenes against one reference.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/compare/args.h"
#include "zoneplate/cli/compare/earlier.h"
#include "zoneplate/cli/compare/page.h"
#include "zoneplate/cli/compare/pictures.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/output_paths.h"
#include "zoneplate/cli/percents.h"
#include "zoneplate/cli/process/confined.h"
#include "zoneplate/cli/process/exr_layer.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/output/film.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/render/sequence.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::cli {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::vector<std::uint8_t> png(const Rgba8Image& image) {
  return encode_png(image, {.has_alpha = false, .may_be_indexed = true});
}

/// Delivers the film `name`, its slice in time and, where there is a reference, the difference from it.
void save_film(const std::string& name, const std::vector<Rgba8Image>& frames, const std::vector<Rgba8Image>& reference,
               Delivery& out) {
  const AnimationFormat format = film_format(trial_frame_rate);
  out.save(name + ".film.png", encode_apng({format, frames}));
  out.save(name + ".slice.png", png(slice_in_time(frames, frames[0].height() / 2)));
  if (reference.empty()) return;
  out.save(name + ".difference.png", encode_apng({format, difference_film(reference, frames)}));
}

void save_files(const SceneTrials& scene, const std::string& folder, Delivery& out) {
  out.save(folder + scene.name + "/reference.png", png(scene.reference_picture));
  for (const Trial& t : scene.trials) {
    const TrialFiles names = files_of(scene, t);
    out.save(folder + names.picture, png(t.picture));
    out.save(folder + names.error_map, png(metrics::paint_magma(t.error_map)));
    out.save(folder + names.worst, png(worst_picture(scene, t)));
    if (!t.film.empty())
      save_film(folder + scene.name + '/' + file_name_of(t.method), t.film, scene.reference_film, out);
  }
  if (!scene.reference_film.empty()) save_film(folder + scene.name + "/reference", scene.reference_film, {}, out);
  out.save(folder + scene.name + "/crops.png", png(crops_picture(scene)));
  out.save_plots(folder + scene.name + "/cost.svg", std::vector{cost_plot(scene)}, 1, {});
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
  const auto shape = [&source, choice](double seconds) mutable {
    choice.time = seconds;
    return source.load_shape(choice);
  };
  return {{at, shape, [&source, choice] { return source.key_times(choice); }},
          args.render.mips,
          {.rate = trial_frame_rate, .duration = args.frames / trial_frame_rate}};
}

SceneTrials compare_scene(const CompareArgs& args, const std::string& name, const TrialOptions& options,
                          const TrialProgress& progress, const MemoryFiles& memory, Delivery& out) {
  Scene scene;
  out.read(name, [&] { scene = load_scene(name, args.render.load); });
  RenderArgs render = args.render;
  render.input = name;
  convert_materials(render, scene);
  const LitStill still = light_still(render, PreparedScene(std::move(scene), render.mips), false);
  const Job& job = still.job;
  const RenderSettings settings = settings_of(job, "");
  TrialSetup setup{still.scene, still.camera, settings, memory, args.frames};
  setup.load_reference = [&] {
    metrics::Picture picture;
    out.read(options.reference, [&] {
      metrics::ImageFile file = metrics::open_image(options.reference);
      file.exr.layer = args.layer;
      picture = metrics::in_srgb(metrics::decode_file(file, out.limits().pixels));
      tell_layer(file, out);
    });
    out.warn_of_flaw(picture.flaw), out.warn_of_flaw(picture.color_flaw);
    return picture;
  };
  std::optional<SceneSource> source;
  std::optional<Sequence> sequence;
  if (args.frames > 1) {
    source.emplace(name, args.render.load);
    sequence.emplace(sequence_of(args, *source));
    const float aspect = static_cast<float>(job.options.width) / static_cast<float>(job.options.height);
    sequence->set_view(job.view, aspect);
    setup.view = [&](int frame) {
      SceneView view = sequence->view(frame);
      view.scene = dimmed(std::move(view.scene), job.light_dimming);
      return view;
    };
  }
  SceneTrials trials = run_trials(setup, options, progress);
  trials.scene = name;
  if (const BuiltinScene* listed = find_builtin_scene(name))
    trials.failure = listed->failure, trials.complaint = listed->complaint;
  if (render.verbosity != Verbosity::Quiet) {
    for (const std::string& warning : still.scene.scene().warnings) out.warn(warning);
    if (!still.warning.empty()) out.warn(still.warning);
  }
  return trials;
}

/// Runs in the confined process. The result is the text to print.
void compare_all(const CompareArgs& args, TrialOptions options, const MemoryFiles& memory, Delivery& out) {
  options.ignored = read_ignored(args.ignored, out), options.ignored_texts = args.ignored.texts;
  // A file that is invalid, or needs a library, is found before the first scene is drawn.
  if (args.scenes.size() > 1)
    for (const std::string& name : args.scenes)
      if (name != "-" && !is_builtin_scene(name)) out.read(name, [&] { load_scene(name, args.render.load); });
  const std::string folder = args.folder();
  std::vector<SceneTrials> scenes;
  ComparisonPage page;
  const double steps = static_cast<double>(args.scenes.size() * (options.methods.size() + 2));
  double done = 0;
  for (const std::string& name : args.scenes) {
    const auto begin_method = [&](const std::string& method) {
      const std::string stage = name + ", " + method;
      out.progress(stage, done / steps);
      const double begin = done++ / steps;
      return percents(begin, done / steps, [&out, stage](double now) { out.progress(stage, now); });
    };
    SceneTrials scene = compare_scene(args, name, options, begin_method, memory, out);
    scene.name = folder_name(name, scenes);
    out.progress(name + ", images", done++ / steps);
    if (!args.render.output.empty()) save_files(scene, folder, out);
    if (!args.page.empty()) page.add(scene);
    // Frees images that are already encoded.
    for (Trial& t : scene.trials) t.picture = {}, t.error_map = {}, t.film = {};
    scene.reference_film = {};
    scenes.push_back(std::move(scene));
  }
  const std::string text = report_text(scenes), json = report_json(scenes, args.command).indented() + '\n';
  out.set_result(bytes_of(args.render.prints_json ? json : text));
  if (!args.page.empty()) out.save(args.page, page.text(scenes));
  if (args.render.output.empty()) return;
  const Plot cost = scenes.size() == 1 ? cost_plot(scenes[0]) : cost_plot(scenes);
  out.save_plots(folder + "cost.svg", std::vector{cost}, 1, {.width = 960, .height = 600});
  out.save(folder + "compare.txt", text);
  out.save(folder + "compare.md", report_markdown(scenes));
  out.save(folder + "compare.csv", report_csv(scenes));
  out.save(folder + "compare.json", json);
}

ReadingLimits limits_of(const CompareArgs& args) {
  return {args.render.load.limits, args.render.max_seconds, args.render.is_sandboxed};
}

/// The files that a comparison may read.
std::vector<std::string> readable_paths_of(const CompareArgs& args, const TrialOptions& options) {
  std::vector<std::string> out = environment_files(args.render);
  for (const std::string& name : args.scenes)
    for (std::string& path : readable_paths(name, args.render.load)) out.push_back(std::move(path));
  if (!args.render.cache.empty()) out.push_back(args.render.cache);
  for (std::string& path : args.render.default_material.files()) out.push_back(std::move(path));
  if (options.is_reference_file) out.push_back(options.reference);
  out.insert(out.end(), args.ignored.masks.begin(), args.ignored.masks.end());
  return out;
}

/// The files of a comparison, in memory until all of them are there.
class ComparedFiles {
 public:
  ComparedFiles(const CompareArgs& args) : args_(args) {}

  /// Takes a file of the folder, or the page.
  void take(const std::string& path, std::vector<std::uint8_t> bytes) {
    const auto refuse = [&](const std::string& why) { throw Error(ErrorKind::Failed, path + ": " + why); };
    size_ += bytes.size();
    if (size_ > args_.render.load.limits.memory)
      refuse("the files of the comparison need more memory than --max-memory allows");
    if (path == args_.page) {
      page_ = std::move(bytes);
      return;
    }
    const std::string folder = args_.folder();
    if (args_.render.output.empty() || !path.starts_with(folder)) refuse("is no file of a comparison");
    files_.push_back({path.substr(folder.size()), std::move(bytes)});
  }
  void save(const EarlierFiles& earlier) const {
    if (!args_.render.output.empty()) save_folder(args_.render.output, files_, earlier);
    if (!args_.page.empty()) save_bytes(args_.page, page_);
  }

 private:
  const CompareArgs& args_;
  std::vector<OutputFile> files_;
  std::vector<std::uint8_t> page_;
  std::uint64_t size_ = 0;
};

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
  EarlierFiles earlier;
  if (args.replaces && !args.render.output.empty()) earlier = earlier_files(args.render.output, limits_of(args));
  if (args.page.empty() || !args.render.output.empty()) check_output_folder(args.render.output, earlier);
  check_scenes(args);
  if (args.render.verbosity == Verbosity::Quiet && !args.render.progress) args.render.progress = ProgressKind::None;
  // Throws before the work if plots cannot be drawn.
  if (!args.render.output.empty()) static_cast<void>(plot_svg({.x = {"x", 0, 1}, .y = {"y", 0, 1}}));
  Progress progress(args.render.progress ? *args.render.progress : parse_progress("auto"));
  ComparedFiles files(args);
  std::vector<std::uint8_t> text;
  std::optional<MemoryFiles> memory;
  const ConfinedRun run{
      .name = args.scenes.size() == 1 ? args.scenes[0] : fmt::format("{} scenes", args.scenes.size()),
      .limits = limits_of(args),
      .readable = readable_paths_of(args, options),
      .outputs = {},
      .progress = &progress,
      .open = [&] { memory.emplace(); },
      .take = [&](const std::string& path, std::vector<std::uint8_t> bytes) { files.take(path, std::move(bytes)); },
      .take_environment =
          [&](std::uint64_t key, const std::vector<std::uint8_t>& bytes) {
            store_environment(args.render.cache, key, bytes);
          }};
  with_isa(args.render.isa, [&] {
    with_threads(args.render.threads, [&] {
      text = run_confined(run, [&](Delivery& out) {
        Environments environments;
        const Environments::Store store = [&](std::uint64_t key, auto bytes) { out.sender().environment(key, bytes); };
        complete_environments(environments, args.render, store, out.sender());
        compare_all(args, options, *memory, out);
      });
    });
  });
  files.save(earlier);  // without other threads, as save_folder requires
  if (args.render.verbosity != Verbosity::Quiet || args.render.prints_json) print_report({text.begin(), text.end()});
}

}  // namespace zoneplate::cli
