// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/evaluate/compare/page.h"
#include "zoneplate/evaluate/compare/pictures.h"
#include "zoneplate/evaluate/compare/report.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/output/film.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/os/file.h"
#include "zoneplate/process/exr_layer.h"
#include "zoneplate/process/percents.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/render/sequence.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate {
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
Sequence sequence_of(const CompareOptions& args, const Job& job, SceneSource& source) {
  SceneChoice choice;
  if (!source.load({}).animations.empty()) choice.animation = 0;
  const auto at = [&job, &source, choice](double seconds) mutable {
    choice.time = seconds;
    Scene scene = source.load(choice);
    set_look(job, scene);
    return scene;
  };
  const auto shape = [&source, choice](double seconds) mutable {
    choice.time = seconds;
    return source.load_shape(choice);
  };
  return {{at, shape, [&source, choice] { return source.key_times(choice); }},
          job.mips,
          {.rate = trial_frame_rate, .duration = args.frames / trial_frame_rate}};
}

SceneTrials compare_scene(const CompareOptions& args, Job render, const std::string& name, const TrialOptions& options,
                          const TrialProgress& progress, const MemoryFiles& memory, Delivery& out) {
  Scene scene;
  out.read(name, [&] { scene = load_scene(name, render.load); });
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
    source.emplace(name, render.load);
    sequence.emplace(sequence_of(args, render, *source));
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
  if (!args.is_quiet) {
    for (const std::string& warning : still.scene.scene().warnings) out.warn(warning);
    if (!still.warning.empty()) out.warn(still.warning);
  }
  return trials;
}

}  // namespace

void compare_all(const CompareOptions& args, const Job& job, TrialOptions options, const MemoryFiles& memory,
                 Delivery& out) {
  options.ignored = read_ignored(args.ignored, out), options.ignored_texts = args.ignored.texts;
  // A file that is invalid, or needs a library, is found before the first scene is drawn.
  if (args.scenes.size() > 1)
    for (const std::string& name : args.scenes)
      if (name != "-" && !is_builtin_scene(name)) out.read(name, [&] { load_scene(name, job.load); });
  const std::string folder = job.output + '/';
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
    SceneTrials scene = compare_scene(args, job, name, options, begin_method, memory, out);
    scene.name = folder_name(name, scenes);
    out.progress(name + ", images", done++ / steps);
    if (!job.output.empty()) save_files(scene, folder, out);
    if (!args.page.empty()) page.add(scene);
    // Frees images that are already encoded.
    for (Trial& t : scene.trials) t.picture = {}, t.error_map = {}, t.film = {};
    scene.reference_film = {};
    scenes.push_back(std::move(scene));
  }
  const std::string text = report_text(scenes), json = report_json(scenes, args.command).indented() + '\n';
  out.set_result(bytes_of(args.prints_json ? json : text));
  if (!args.page.empty()) out.save(args.page, page.text(scenes));
  if (job.output.empty()) return;
  const Plot cost = scenes.size() == 1 ? cost_plot(scenes[0]) : cost_plot(scenes);
  out.save_plots(folder + "cost.svg", std::vector{cost}, 1, {.width = 960, .height = 600});
  out.save(folder + "compare.txt", text);
  out.save(folder + "compare.md", report_markdown(scenes));
  out.save(folder + "compare.csv", report_csv(scenes));
  out.save(folder + "compare.json", json);
}

void ComparedFiles::take(const std::string& path, std::vector<std::uint8_t> bytes) {
  const auto refuse = [&](const std::string& why) { throw Error(ErrorKind::Failed, path + ": " + why); };
  size_ += bytes.size();
  if (size_ > job_.load.limits.memory) refuse("the files of the comparison need more memory than --max-memory allows");
  if (path == args_.page) {
    page_ = std::move(bytes);
    return;
  }
  const std::string folder = job_.output + '/';
  if (job_.output.empty() || !path.starts_with(folder)) refuse("is no file of a comparison");
  files_.push_back({path.substr(folder.size()), std::move(bytes)});
}

void ComparedFiles::save(const EarlierFiles& earlier) const {
  if (!job_.output.empty()) save_folder(job_.output, files_, earlier);
  if (!args_.page.empty()) save_bytes(args_.page, page_);
}

}  // namespace zoneplate
