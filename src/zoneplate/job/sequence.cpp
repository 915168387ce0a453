// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/job/output/background.h"
#include "zoneplate/job/output/film.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/render/sequence.h"

namespace zoneplate {
namespace {

// The frames to render, and their animation.
class Plan {
 public:
  // `given`: a scene at rest in memory; null: that of `source`.
  Plan(const Job& job, SceneSource* source, const PreparedScene* given) : job_(job), source_(source), given_(given) {
    choice_ = job.load.choice;
    if (given != nullptr) {
      list_frames();
      return;
    }
    // A turntable does not animate the scene unless an animation is chosen.
    const bool has_animation = job.load.choice.animation || !job.load.choice.animation_name.empty();
    const bool is_chosen = has_animation || job.has_animation_time;
    Scene scene = load(&SceneSource::load, choice_.time);
    const bool is_orbit = job.sequence.turntable || !job.sequence.views.empty();
    if (!has_animation && !scene.animations.empty() && (is_chosen || !is_orbit)) {
      choice_.animation = 0;
      if (scene.animations.size() > 1)
        notes_.push_back(fmt::format(
            "{}: animation 0 of {}{}; --animation-index chooses another, by index or name, or all", job.input,
            scene.animations.size(), scene.animations[0].name.empty() ? "" : " (" + scene.animations[0].name + ")"));
    }
    end_ = end_of_animation(choice_, scene);
    is_animated_ = choice_.animation || !choice_.animation_name.empty();
    if (!is_animated_) still_ = std::move(scene);
    list_frames();
    if (still_ && !is_orbit && !job.sequence.camera_path && frames_.size() > 1)
      notes_.push_back(fmt::format("{}: has no animation, so that all {} frames show the same; see --turntable",
                                   job.input, frames_.size()));
    if (std::string late = lateness(job, end_); !late.empty()) notes_.push_back(std::move(late));
  }

  const std::vector<int>& frames() const { return frames_; }
  // What the user may not expect: which of several animations is played, or that nothing moves.
  const std::vector<std::string>& notes() const { return notes_; }
  // Those by whose lights all frames are dimmed, whichever are rendered: the first one, and of an animation four more,
  // evenly to its end.
  std::vector<double> metered_frames() const {
    constexpr int parts = 4;
    std::vector<double> out = {0};
    for (int i = 1; i <= parts && is_animated_; ++i) out.push_back(end_ * job_.sequence.rate * i / parts);
    return out;
  }
  bool is_animated() const { return is_animated_; }
  // Of the scene that was made last.
  ToneMapping tone_mapping() const { return tone_mapping_; }

  Sequence sequence() {
    constexpr double resting = 1e12;  // frames per second: all have the time of the first
    const SequenceTiming timing{.rate = job_.sequence.views.empty() ? job_.sequence.rate : resting,
                                .start = job_.load.choice.time,
                                .duration = end_,
                                .turntable = job_.sequence.turntable};
    if (given_ != nullptr) {
      const Lighting lighting = make_lighting(given_->scene(), job_.lighting);
      tone_mapping_ = lighting.tone_mapping;
      return Sequence(given_->lit(lighting), timing);
    }
    if (still_) {
      tone_mapping_ = set_look(job_, *still_);
      return Sequence(PreparedScene(std::move(*still_), job_.mips), timing);
    }
    const auto load_scene = [this](double seconds) {
      Scene scene = load(&SceneSource::load, seconds);
      tone_mapping_ = set_look(job_, scene);
      return scene;
    };
    const auto load_shape = [this](double seconds) { return load(&SceneSource::load_shape, seconds); };
    const auto key_times = [this] {
      std::vector<double> times;
      within_import_time(job_.input, job_.load.limits, [&] { times = source_->key_times(choice_); });
      return times;
    };
    return Sequence({load_scene, load_shape, key_times}, job_.mips, timing);
  }

 private:
  Scene load(Scene (SceneSource::*loader)(const SceneChoice&), double seconds) {
    SceneChoice choice = choice_;
    choice.time = seconds;
    Scene scene;
    within_import_time(job_.input, job_.load.limits, [&] { scene = (source_->*loader)(choice); });
    return scene;
  }

  // The number of the animation's last frame.
  int last_of_animation(int first) const {
    const SequenceArgs& s = job_.sequence;
    const double last = std::floor(end_ * s.rate + 1e-6);
    if (!((last - first) / s.jump < max_frames))
      throw Error(ErrorKind::Input,
                  fmt::format("{}: its animation ends at {:.6g} s, which is more than {} frames: choose some of them "
                              "with --frames or --frame-end",
                              job_.input, end_, max_frames));
    return static_cast<int>(std::max(last, -1.0));
  }

  void list_frames() {
    const SequenceArgs& s = job_.sequence;
    const int first = s.first.value_or(0);
    const std::optional<std::int64_t> asked = s.last_frame();
    const std::int64_t last = asked ? *asked : last_of_animation(first);
    if (last < first) throw Error(ErrorKind::Usage, fmt::format("there is no frame from {} to {}", first, last));
    if (last > std::numeric_limits<int>::max())
      throw Error(ErrorKind::Usage, fmt::format("no frame has the number {}", last));
    if ((last - first) / s.jump >= max_frames)
      throw Error(ErrorKind::Usage, fmt::format("more than {} frames", max_frames));
    for (std::int64_t f = first; f <= last; f += s.jump) frames_.push_back(static_cast<int>(f));
  }

  const Job& job_;
  SceneSource* source_;
  const PreparedScene* given_;
  SceneChoice choice_;
  std::vector<std::string> notes_;
  ToneMapping tone_mapping_ = ToneMapping::None;
  double end_ = 0;  // end of the animation, in seconds
  bool is_animated_ = false;
  std::optional<Scene> still_;  // the scene, if it is not animated
  std::vector<int> frames_;
};

/// The motion of surfaces that a section cuts anew in every frame is not known.
void check_section(const Job& job, const Resolver& method, bool is_animated) {
  if (job.section.planes.empty() || !is_animated) return;
  const bool has_motion = std::ranges::any_of(
      job.aovs, [](const Aov* aov) { return aov->plane == &Planes::motion || aov->plane == &Planes::flow; });
  if (has_motion || method.has_history())
    throw Error(ErrorKind::Usage,
                "--section of an animated model excludes --aov motion and flow, and methods that average frames");
}

/// A method with history needs all frames in order.
void check_history(const Job& job, const Resolver& method) {
  if (!method.has_history() && job.sequence.warm_up > 0)
    throw Error(ErrorKind::Usage,
                fmt::format("--warm-up is for methods that average frames, and {} does not", job.method));
  if (!method.has_history()) return;
  const auto refuse = [&](const std::string& option) {
    throw Error(ErrorKind::Usage,
                fmt::format("--anti-aliasing {}: it averages frames, which excludes {}", job.method, option));
  };
  if (job.sequence.shutter && job.sequence.shutter_samples > 1) refuse("--shutter");
  if (job.sequence.skips_finished) refuse("--skip-existing: a frame depends on those before it");
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

std::string lateness(const Job& job, double end) {
  const double time = job.load.choice.time;
  if (!job.has_animation_time || !(time > end)) return "";
  return end > 0 ? fmt::format(
                       "{}: --animation-time {:.6g} is after the end of the animation at {:.6g} s: its last "
                       "pose is shown",
                       job.input, time, end)
                 : fmt::format("{}: has no animation, so that --animation-time changes nothing", job.input);
}

bool is_film(const std::string& output) {
  const std::string extension = extension_of(output);
  return extension == ".apng" || extension == ".webp" || is_encoded_by_ffmpeg(output);
}

struct JobFrames::State {
  State(Job given_job, std::unique_ptr<Resolver> method, JobSink& sink, const PreparedScene* given)
      : job(std::move(given_job)), source(given == nullptr ? open(job) : nullptr), plan(job, source.get(), given) {
    sink.has_read();
    check_passes(job, request_of(job, *method));
    check_history(job, *method);
    check_section(job, *method, plan.is_animated());
    sequence.emplace(plan.sequence());
    // What all frames share and the scene decides, it decides at frame 0, whichever frames are rendered: nothing
    // flickers, and the parts of a sequence look alike.
    renderer.emplace(sequence->scene(0), std::move(method));
    job = resolve(std::move(job), renderer->scene().scene(), plan.tone_mapping());
    const float aspect = static_cast<float>(job.options.width) / static_cast<float>(job.options.height);
    set_camera(aspect);
    warnings = sequence->scene(plan.frames().front()).scene().warnings;
    set_brightness();
    warnings.insert(warnings.end(), plan.notes().begin(), plan.notes().end());
  }

  static std::unique_ptr<SceneSource> open(const Job& job) {
    std::unique_ptr<SceneSource> out;
    within_import_time(job.input, job.load.limits, [&] { out = std::make_unique<SceneSource>(job.input, job.load); });
    return out;
  }

  /// The camera of all frames, or of each.
  void set_camera(float aspect) {
    const SequenceArgs& s = job.sequence;
    if (s.camera_path)
      return sequence->set_views(
          [this](double frame) { return job.sequence.camera_path->at(frame / job.sequence.rate, job.view); }, aspect);
    if (s.views.empty()) return sequence->set_view(job.view, aspect);
    sequence->set_views(
        [this](double frame) {
          const std::vector<ViewDirection>& views = job.sequence.views;
          const auto last = static_cast<double>(views.size() - 1);
          const ViewDirection& direction = views[static_cast<std::size_t>(std::clamp(frame, 0.0, last))];
          View view = job.view;
          view.azimuth = direction.azimuth, view.elevation = direction.elevation;
          return view;
        },
        aspect);
  }

  /// As resolve does for a still image, of frame 0 and of those that are metered.
  void set_brightness() {
    if (renderer->scene().scene().needs_fill_light) {
      std::string warning;
      for (const double frame : plan.metered_frames()) {
        Job own = job;
        std::string its_warning = set_light_dimming(own, sequence->scene(frame), is_linear(job.output));
        if (own.light_dimming < job.light_dimming)
          job.light_dimming = own.light_dimming, warning = std::move(its_warning);
      }
      if (!warning.empty()) warnings.push_back(std::move(warning));
    }
    if (!job.meters_exposure) return;
    const SceneView start = sequence->view(0);
    job.display.exposure = metered_exposure(start.scene, start.camera, job);
  }

  SceneView view(double frame) {
    SceneView out = sequence->view(frame);
    out.scene = dimmed(std::move(out.scene), job.light_dimming);
    return out;
  }

  /// Renders frames before this one, for the history of the method.
  void warm_up(int frame, int count) {
    const RenderSettings settings = settings_of(job, job.output);
    for (int i = count; i > 0; --i) {
      SceneView earlier = view(frame - i * job.sequence.jump);
      renderer->set_scene(std::move(earlier.scene));
      renderer->render(earlier.camera, settings);
    }
  }

  /// Renders a frame; its shutter opens at the frame's time.
  JobImage render(int frame, std::function<void(double)> progress) {
    RenderSettings settings = settings_of(job, job.output);
    settings.options.progress = std::move(progress);
    const int samples = job.sequence.shutter ? job.sequence.shutter_samples : 1;
    JobImage out{.frame = frame, .image = {}, .camera = {}};
    if (samples > 1) {
      const double open = *job.sequence.shutter / 360;
      const auto moment = [&](int i) {
        SceneView at = view(shutter_time(frame, open, i, samples, job.sequence.shutter_filter));
        if (i == 0) out.camera = at.camera;
        return at;
      };
      out.image = renderer->render_mean(samples, moment, settings);
      return out;
    }
    if (settings.planes.motion) settings.options.last = sequence->moment(frame - job.sequence.jump);
    if (settings.planes.flow) settings.options.next = sequence->moment(frame + job.sequence.jump);
    SceneView now = view(frame);
    renderer->set_scene(std::move(now.scene));
    out.camera = now.camera;
    // Views have nothing in common that a history could keep.
    out.image = job.sequence.views.empty() ? renderer->render(now.camera, settings)
                                           : renderer->render_still(now.camera, settings);
    return out;
  }

  Job job;
  std::unique_ptr<SceneSource> source;
  Plan plan;
  std::optional<Sequence> sequence;
  std::optional<Renderer> renderer;
  std::vector<std::string> warnings;
  std::size_t done = 0;
};

JobFrames::JobFrames(Job job, std::unique_ptr<Resolver> method, JobSink& sink, const PreparedScene* given)
    : state_(std::make_unique<State>(std::move(job), std::move(method), sink, given)) {}
JobFrames::~JobFrames() = default;

const Job& JobFrames::job() const { return state_->job; }
const std::vector<int>& JobFrames::frames() const { return state_->plan.frames(); }
const Scene& JobFrames::scene() const { return prepared().scene(); }
const PreparedScene& JobFrames::prepared() const { return state_->renderer->scene(); }
std::size_t JobFrames::done() const { return state_->done; }
std::vector<std::string>& JobFrames::warnings() { return state_->warnings; }

void JobFrames::skip() {
  if (state_->done == 0) state_->warm_up(frames().front(), state_->job.sequence.warm_up);
  ++state_->done;
  state_->renderer->begin_sequence();
}

void JobFrames::seek(int frame, int warm_up) {
  const auto found = std::ranges::find(frames(), frame);
  if (found == frames().end())
    throw Error(ErrorKind::Usage,
                fmt::format("there is no frame {}, only {} to {}", frame, frames().front(), frames().back()));
  state_->renderer->begin_sequence();
  state_->warm_up(frame, warm_up);
  state_->done = static_cast<std::size_t>(found - frames().begin());
}

JobImage JobFrames::next(std::function<void(double)> progress) {
  State& s = *state_;
  if (s.done == 0) s.warm_up(frames().front(), s.job.sequence.warm_up);
  const int frame = frames().at(s.done++);
  JobImage out = s.render(frame, std::move(progress));
  if (frame != frames().front()) return out;
  const auto metered = [&] {
    const SceneView view = s.view(frame);
    return metered_exposure(view.scene, view.camera, s.job);
  };
  if (std::string warning = clipping(s.job, out.image.display, metered); !warning.empty())
    s.warnings.push_back(std::move(warning));
  return out;
}

namespace {

/// What the user may not expect of the file.
void add_output_warnings(const Job& job, std::size_t frames, bool is_numbered, std::vector<std::string>& warnings) {
  if (!is_numbered && frames == 1 && !is_one_frame(job.sequence))
    warnings.push_back(
        fmt::format("{}: has no animation, so that {} has one frame; see --turntable", job.input, job.output));
  if (extension_of(job.output) == ".gif" && job.sequence.rate > max_gif_rate)
    warnings.push_back(fmt::format("{}: has {} of {:g} frames per second, as many as a GIF can have in browsers",
                                   job.output, max_gif_rate, job.sequence.rate));
}

}  // namespace

void render_sequence(Job job, std::unique_ptr<Resolver> method, JobSink& out, Summary& summary,
                     const PreparedScene* given) {
  const bool has_number = job.frame_place.has_value();
  if (!has_number && !is_film(job.output) && !is_one_frame(job.sequence))
    throw Error(ErrorKind::Usage,
                job.output +
                    ": several frames require a frame number in OUT, as chair.####.png, or a video: .apng, "
                    ".webp, .gif, .mp4, .mov, .mkv, .webm");
  const bool is_numbered = has_number || !is_film(job.output);
  if (!is_numbered && !job.aovs.empty())
    throw Error(ErrorKind::Usage, "--aov requires numbered frames, as chair.####.png");
  JobFrames frames(std::move(job), std::move(method), out, given);
  const Job& resolved = frames.job();
  const std::size_t count = frames.frames().size();
  add_output_warnings(resolved, count, is_numbered, frames.warnings());
  AnimationFormat format = film_format(resolved.sequence.rate);
  std::unique_ptr<AnimationEncoder> film;
  Background background;
  const auto is_finished = [&finished = resolved.sequence.finished](int frame) {
    return std::binary_search(finished.begin(), finished.end(), frame);
  };
  for (const int frame : frames.frames()) {
    const std::string stage = fmt::format("frame {} of {}", frames.done() + 1, count);
    const auto part = [&] { return static_cast<double>(frames.done()) / static_cast<double>(count); };
    const double begin = part(), end = begin + 1 / static_cast<double>(count);
    out.progress(stage, begin);
    const std::string output = is_numbered ? output_path(resolved, frame, -1) : resolved.output;
    if (is_finished(frame)) {
      frames.skip();
      continue;
    }
    JobImage image = frames.next(out.progress_of(stage, begin, end));
    Rendered picture =
        finish_picture(resolved, std::move(image.image), frames.scene(), image.camera, output, summary, frame);
    if (is_numbered) {
      const auto send = [&out, picture = std::make_shared<Rendered>(std::move(picture)), output, frame,
                         compression = resolved.file] {
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
      if (!film) film = make_film_encoder(resolved.output, format, resolved.file.webp_quality);
      background.run(film->add(std::make_shared<const Rgba8Image>(std::move(picture.image))));
    }
  }
  background.wait();
  summary.exposure = resolved.display.exposure;
  summary.frames = static_cast<int>(count);
  summary.warnings.insert(summary.warnings.end(), frames.warnings().begin(), frames.warnings().end());
  if (film) out.file(-1, -1, film->finish());
}

}  // namespace zoneplate
