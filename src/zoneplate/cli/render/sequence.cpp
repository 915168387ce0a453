// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/background.h"
#include "zoneplate/cli/render/film.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/render/sequence.h"

namespace zoneplate::cli {
namespace {

// The frames to render, and their animation.
class Plan {
 public:
  Plan(const RenderArgs& args, SceneSource& source) : args_(args), source_(source) {
    // A turntable does not animate the scene unless an animation is chosen.
    const bool has_animation = args.load.choice.animation || !args.load.choice.animation_name.empty();
    const bool is_chosen = has_animation || args.has_animation_time;
    choice_ = args.load.choice;
    Scene scene = load(&SceneSource::load, choice_.time);
    const bool is_orbit = args.sequence.turntable || !args.sequence.views.empty();
    if (!has_animation && !scene.animations.empty() && (is_chosen || !is_orbit)) {
      choice_.animation = 0;
      if (scene.animations.size() > 1)
        notes_.push_back(fmt::format(
            "{}: animation 0 of {}{}; --animation-index chooses another, by index or name, or all", args.input,
            scene.animations.size(), scene.animations[0].name.empty() ? "" : " (" + scene.animations[0].name + ")"));
    }
    end_ = end_of_animation(choice_, scene);
    is_animated_ = choice_.animation || !choice_.animation_name.empty();
    if (!is_animated_) still_ = std::move(scene);
    list_frames();
    if (still_ && !is_orbit && !args.sequence.camera_path && frames_.size() > 1)
      notes_.push_back(fmt::format("{}: has no animation, so that all {} frames show the same; see --turntable",
                                   args.input, frames_.size()));
    if (std::string late = lateness(args, end_); !late.empty()) notes_.push_back(std::move(late));
  }

  const std::vector<int>& frames() const { return frames_; }
  // What the user may not expect: which of several animations is played, or that nothing moves.
  const std::vector<std::string>& notes() const { return notes_; }
  // Those by whose lights all frames are dimmed, whichever are rendered: the first one, and of an animation four more,
  // evenly to its end.
  std::vector<double> metered_frames() const {
    constexpr int parts = 4;
    std::vector<double> out = {0};
    for (int i = 1; i <= parts && is_animated_; ++i) out.push_back(end_ * args_.sequence.rate * i / parts);
    return out;
  }
  bool is_animated() const { return is_animated_; }
  // Of the scene that was made last.
  ToneMapping tone_mapping() const { return tone_mapping_; }

  Sequence sequence() {
    constexpr double resting = 1e12;  // frames per second: all have the time of the first
    const SequenceTiming timing{.rate = args_.sequence.views.empty() ? args_.sequence.rate : resting,
                                .start = args_.load.choice.time,
                                .duration = end_,
                                .turntable = args_.sequence.turntable};
    if (still_) {
      tone_mapping_ = set_look(args_, *still_);
      return Sequence(PreparedScene(std::move(*still_), args_.mips), timing);
    }
    const auto load_scene = [this](double seconds) {
      Scene scene = load(&SceneSource::load, seconds);
      tone_mapping_ = set_look(args_, scene);
      return scene;
    };
    const auto load_shape = [this](double seconds) { return load(&SceneSource::load_shape, seconds); };
    const auto key_times = [this] {
      std::vector<double> times;
      within_import_time(args_.input, args_.load.limits, [&] { times = source_.key_times(choice_); });
      return times;
    };
    return Sequence({load_scene, load_shape, key_times}, args_.mips, timing);
  }

 private:
  Scene load(Scene (SceneSource::*loader)(const SceneChoice&), double seconds) {
    SceneChoice choice = choice_;
    choice.time = seconds;
    Scene scene;
    within_import_time(args_.input, args_.load.limits, [&] { scene = (source_.*loader)(choice); });
    return scene;
  }

  // The number of the animation's last frame.
  int last_of_animation(int first) const {
    const SequenceArgs& s = args_.sequence;
    const double last = std::floor(end_ * s.rate + 1e-6);
    if (!((last - first) / s.jump < most_frames))
      throw Error(ErrorKind::Input,
                  fmt::format("{}: its animation ends at {:.6g} s, which is more than {} frames: choose some of them "
                              "with --frames or --frame-end",
                              args_.input, end_, most_frames));
    return static_cast<int>(std::max(last, -1.0));
  }

  void list_frames() {
    const SequenceArgs& s = args_.sequence;
    const int first = s.first.value_or(0);
    const std::optional<std::int64_t> asked = s.last_frame();
    const std::int64_t last = asked ? *asked : last_of_animation(first);
    if (last < first) throw Error(ErrorKind::Usage, fmt::format("there is no frame from {} to {}", first, last));
    if (last > std::numeric_limits<int>::max())
      throw Error(ErrorKind::Usage, fmt::format("no frame has the number {}", last));
    if ((last - first) / s.jump >= most_frames)
      throw Error(ErrorKind::Usage, fmt::format("more than {} frames", most_frames));
    for (std::int64_t f = first; f <= last; f += s.jump) frames_.push_back(static_cast<int>(f));
  }

  const RenderArgs& args_;
  SceneSource& source_;
  SceneChoice choice_;
  std::vector<std::string> notes_;
  ToneMapping tone_mapping_ = ToneMapping::None;
  double end_ = 0;  // end of the animation, in seconds
  bool is_animated_ = false;
  std::optional<Scene> still_;  // the scene, if it is not animated
  std::vector<int> frames_;
};

// Renders a frame; its shutter opens at the frame's time.
Rendered render_frame(const RenderArgs& args, Sequence& sequence, int frame, const std::string& output,
                      Renderer& renderer, std::function<void(double)> progress, Summary& summary) {
  RenderSettings settings = settings_of(args, output);
  settings.options.progress = std::move(progress);
  const int samples = args.sequence.shutter ? args.sequence.shutter_samples : 1;
  RenderedImage image;
  Camera camera;
  if (samples > 1) {
    const double open = *args.sequence.shutter / 360;
    image = renderer.render_mean(
        samples,
        [&](int i) {
          SceneView view = sequence.view(shutter_time(frame, open, i, samples, args.sequence.shutter_filter));
          view.scene = dimmed(std::move(view.scene), args.light_dimming);
          if (i == 0) camera = view.camera;
          return view;
        },
        settings);
  } else {
    if (settings.planes.motion) settings.options.last = sequence.moment(frame - args.sequence.jump);
    if (settings.planes.flow) settings.options.next = sequence.moment(frame + args.sequence.jump);
    SceneView view = sequence.view(frame);
    renderer.set_scene(dimmed(std::move(view.scene), args.light_dimming));
    camera = view.camera;
    // Views have nothing in common that a history could keep.
    image = args.sequence.views.empty() ? renderer.render(camera, settings) : renderer.render_still(camera, settings);
  }
  return finish_picture(args, std::move(image), renderer.scene().scene(), camera, output, summary, frame);
}

/// The motion of surfaces that a section cuts anew in every frame is not known.
void check_section(const RenderArgs& args, const Resolver& method, bool is_animated) {
  if (args.section.planes.empty() || !is_animated) return;
  const bool has_motion = std::ranges::any_of(
      args.aovs, [](const Aov* aov) { return aov->plane == &Planes::motion || aov->plane == &Planes::flow; });
  if (has_motion || method.has_history())
    throw Error(ErrorKind::Usage,
                "--section of an animated model excludes --aov motion and flow, and methods that average frames");
}

/// A method with history needs all frames in order.
void check_history(const RenderArgs& args, const Resolver& method) {
  if (!method.has_history() && args.sequence.warm_up > 0)
    throw Error(ErrorKind::Usage,
                fmt::format("--warm-up is for methods that average frames, and {} does not", args.method));
  if (!method.has_history()) return;
  const auto refuse = [&](const std::string& option) {
    throw Error(ErrorKind::Usage,
                fmt::format("--anti-aliasing {}: it averages frames, which excludes {}", args.method, option));
  };
  if (args.sequence.shutter && args.sequence.shutter_samples > 1) refuse("--shutter");
  if (args.skip_existing) refuse("--skip-existing: a frame depends on those before it");
}

/// Renders the frames before the first one, for the history of the method.
void warm_up(const RenderArgs& args, Sequence& sequence, int first, Renderer& renderer) {
  const RenderSettings settings = settings_of(args, args.output);
  for (int i = args.sequence.warm_up; i > 0; --i) {
    SceneView view = sequence.view(first - i * args.sequence.jump);
    renderer.set_scene(dimmed(std::move(view.scene), args.light_dimming));
    renderer.render(view.camera, settings);
  }
}

/// The camera of all frames, or of each.
void set_camera(const RenderArgs& args, float aspect, Sequence& sequence) {
  const SequenceArgs& s = args.sequence;
  if (s.camera_path)
    return sequence.set_views([&, rate = s.rate](double frame) { return s.camera_path->at(frame / rate, args.view); },
                              aspect);
  if (s.views.empty()) return sequence.set_view(args.view, aspect);
  sequence.set_views(
      [&](double frame) {
        const auto last = static_cast<double>(s.views.size() - 1);
        const ViewDirection& direction = s.views[static_cast<std::size_t>(std::clamp(frame, 0.0, last))];
        View view = args.view;
        view.azimuth = direction.azimuth, view.elevation = direction.elevation;
        return view;
      },
      aspect);
}

bool is_one_frame(const SequenceArgs& s) { return s.count == 1 || (s.first && s.first == s.last); }

}  // namespace

double end_of_animation(const SceneChoice& choice, const Scene& scene) {
  const auto plays = [&](const AnimationSpan& span) {
    if (!choice.animation_name.empty()) return span.name == choice.animation_name;
    return choice.animation == SceneChoice::all_animations ||
           choice.animation == static_cast<int>(&span - scene.animations.data());
  };
  double end = 0;
  for (const AnimationSpan& span : scene.animations)
    if (plays(span)) end = std::max(end, static_cast<double>(span.end));
  return end;
}

std::string lateness(const RenderArgs& args, double end) {
  const double time = args.load.choice.time;
  if (!args.has_animation_time || !(time > end)) return "";
  return end > 0 ? fmt::format(
                       "{}: --animation-time {:.6g} is after the end of the animation at {:.6g} s: its last "
                       "pose is shown",
                       args.input, time, end)
                 : fmt::format("{}: has no animation, so that --animation-time changes nothing", args.input);
}

bool is_film(const std::string& output) {
  const std::string extension = extension_of(output);
  return extension == ".apng" || extension == ".webp" || is_encoded_by_ffmpeg(output);
}

void render_sequence(RenderArgs args, std::unique_ptr<Resolver> method, ItemSender& out, Summary& summary) {
  const bool has_number = args.frame_place.has_value();
  if (!has_number && !is_film(args.output) && !is_one_frame(args.sequence))
    throw Error(ErrorKind::Usage,
                args.output +
                    ": several frames require a frame number in OUT, as chair.####.png, or a video: .apng, "
                    ".webp, .gif, .mp4, .mov, .mkv, .webm");
  SceneSource source(args.input, args.load);
  Plan plan(args, source);
  out.has_read();
  const bool is_numbered = has_number || !is_film(args.output);
  check_passes(args, request_of(args, *method));
  check_history(args, *method);
  check_section(args, *method, plan.is_animated());
  Sequence sequence = plan.sequence();
  // What all frames share and the scene decides, it decides at frame 0, whichever frames are rendered: nothing
  // flickers, and the parts of a sequence look alike.
  Renderer renderer(sequence.scene(0), std::move(method));
  args.display.mapping = plan.tone_mapping();
  set_usual_options(args, renderer.scene().scene());
  args.view.up = args.up.value_or(renderer.scene().scene().up);
  const bool is_animated = !renderer.scene().scene().animations.empty();
  if (is_builtin_scene(args.input) && is_animated && !args.view.index && !args.view.position) args.view.index = 0;
  const float aspect = static_cast<float>(args.options.width) / static_cast<float>(args.options.height);
  if (!is_numbered && !args.aovs.empty())
    throw Error(ErrorKind::Usage, "--aov requires numbered frames, as chair.####.png");
  set_camera(args, aspect, sequence);
  summary.warnings = sequence.scene(plan.frames().front()).scene().warnings;
  if (renderer.scene().scene().needs_fill_light) {
    std::string warning;
    for (const double frame : plan.metered_frames()) {
      RenderArgs own = args;
      std::string its_warning = set_light_dimming(own, sequence.scene(frame), args.output);
      if (own.light_dimming < args.light_dimming)
        args.light_dimming = own.light_dimming, warning = std::move(its_warning);
    }
    if (!warning.empty()) summary.warnings.push_back(std::move(warning));
  }
  if (args.meters_exposure) {
    const SceneView start = sequence.view(0);
    args.display.exposure = metered_exposure(start.scene, start.camera, args);
  }
  summary.exposure = args.display.exposure;
  summary.warnings.insert(summary.warnings.end(), plan.notes().begin(), plan.notes().end());
  if (!is_numbered && plan.frames().size() == 1 && !is_one_frame(args.sequence))
    summary.warnings.push_back(
        fmt::format("{}: has no animation, so that {} has one frame; see --turntable", args.input, args.output));

  if (extension_of(args.output) == ".gif" && args.sequence.rate > most_gif_rate)
    summary.warnings.push_back(
        fmt::format("{}: has {} of {:g} frames per second, as many as a GIF can have in browsers", args.output,
                    most_gif_rate, args.sequence.rate));

  warm_up(args, sequence, plan.frames().front(), renderer);
  AnimationFormat format = film_format(args.sequence.rate);
  std::unique_ptr<AnimationEncoder> film;
  Background background;
  std::size_t done = 0;
  for (const int frame : plan.frames()) {
    const std::size_t count = plan.frames().size();
    const std::string stage = fmt::format("frame {} of {}", done + 1, count);
    const double begin = static_cast<double>(done) / static_cast<double>(count);
    out.progress(stage, begin);
    ++done;
    const std::string output = is_numbered ? output_path(args, frame, -1) : args.output;
    if (std::ranges::binary_search(args.sequence.finished, frame)) {
      renderer.begin_sequence();
      continue;
    }
    const double end = static_cast<double>(done) / static_cast<double>(count);
    Rendered picture =
        render_frame(args, sequence, frame, output, renderer, out.progress_of(stage, begin, end), summary);
    if (frame == plan.frames().front()) {
      const auto metered = [&] {
        const SceneView view = sequence.view(frame);
        return metered_exposure(dimmed(view.scene, args.light_dimming), view.camera, args);
      };
      if (std::string warning = clipping(args, picture, metered); !warning.empty())
        summary.warnings.push_back(std::move(warning));
    }
    if (is_numbered) {
      const auto send = [&out, picture = std::make_shared<Rendered>(std::move(picture)), output, frame,
                         compression = args.file] {
        for (const LayerFile& file : picture->layers) out.file(frame, file.aov, file.bytes);
        out.file(frame, -1, encode_picture(*picture, output, compression));  // last: --skip-existing looks for it
      };
      // PNG encoding uses all threads itself.
      if (extension_of(output) == ".png")
        send();
      else
        background.run(send);
    } else if (is_encoded_by_ffmpeg(output)) {
      out.film_frame(picture.image);
    } else {
      format.has_alpha = picture.has_alpha;
      if (!film) film = make_film_encoder(args.output, format, args.file.webp_quality);
      background.run(film->add(std::make_shared<const Rgba8Image>(std::move(picture.image))));
    }
  }
  background.wait();
  summary.frames = static_cast<int>(plan.frames().size());
  if (film) out.file(-1, -1, film->finish());
}

}  // namespace zoneplate::cli
