#include "zoneplate/cli/render/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/background.h"
#include "zoneplate/cli/render/film.h"
#include "zoneplate/cli/render/frame_name.h"
#include "zoneplate/cli/stage.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/shade/surface/material_plan.h"

namespace zoneplate::cli {
namespace {

constexpr int most_frames = 100'000;
constexpr double tau = 6.28318530717958647692;

// All that moves, and when.
class Plan {
 public:
  Plan(const RenderArgs& args, SceneSource& source) : args_(args), source_(source) {
    // A turntable leaves the animation alone, unless one is asked for.
    const bool is_asked = args.load.choice.animation || args.has_animation_time;
    choice_ = args.load.choice;
    Scene scene = load(choice_);
    if (!choice_.animation && !scene.animations.empty() && (is_asked || !args.sequence.turntable))
      choice_.animation = SceneChoice::all_animations;
    for (std::size_t i = 0; choice_.animation && i < scene.animations.size(); ++i)
      if (*choice_.animation == SceneChoice::all_animations || *choice_.animation == static_cast<int>(i))
        end_ = std::max(end_, static_cast<double>(scene.animations[i].end));
    stage_ = std::make_unique<Stage>(std::move(scene));
    list_frames();
  }

  const std::vector<int>& frames() const { return frames_; }
  bool is_animated() const { return choice_.animation.has_value(); }
  double time_of(double frame) const { return args_.load.choice.time + frame / args_.sequence.rate; }

  // The scene at a moment, in frames.
  Stage& stage(double frame) {
    if (!is_animated()) return *stage_;
    SceneChoice choice = choice_;
    choice.time = time_of(frame);
    *stage_ = Stage(load(choice));
    return *stage_;
  }

  // The scene's shape at another moment than the stage's: in `memory`, or the stage's own where nothing is animated.
  const Scene& shape(double frame, Scene& memory) {
    if (!is_animated()) return stage_->scene();
    SceneChoice choice = choice_;
    choice.time = time_of(frame);
    return memory = load_shape(choice);
  }

  // What the frames have in common is made once. `scene`: lit, a stage's.
  void share(const Scene& scene, RenderOptions& options) {
    if (!textures_) textures_.emplace(scene, options.raw_colors);
    options.textures = &*textures_;
    options.memory = &memory_;
    if (is_animated()) return;
    if (!records_) records_.emplace(scene);
    options.records = &*records_;
  }

  // The camera that every frame is seen by, before the turntable turns it.
  Camera still_camera(const View& view, float aspect) {
    Scene all = whole();
    centre_ = all.bounds().empty() ? float3{} : all.bounds().centre();
    if (args_.sequence.turntable && !view.position && !view.index) add_turns(all, view.up);
    return choose_camera(all, view, aspect);
  }

  Camera camera(const Camera& still, const Scene& scene, const View& view, float aspect, double frame) const {
    Camera camera = view.index && is_animated() ? choose_camera(scene, view, aspect) : still;
    if (!args_.sequence.turntable) return camera;
    const auto angle = static_cast<float>(tau * frame / *args_.sequence.turntable);
    camera.world_from_camera = turned(view.up, angle) * camera.world_from_camera;
    return camera;
  }

 private:
  Scene load(const SceneChoice& choice) {
    Scene scene;
    within_import_time(args_.input, args_.load.limits, [&] { scene = source_.load(choice); });
    return scene;
  }
  Scene load_shape(const SceneChoice& choice) {
    Scene scene;
    within_import_time(args_.input, args_.load.limits, [&] { scene = source_.load_shape(choice); });
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
    const bool has_last = s.turntable || s.count || s.last;
    int last = s.turntable ? *s.turntable - 1 : has_last ? 0 : last_of_animation(first);
    if (s.count) last = first + (*s.count - 1) * s.jump;
    if (s.last) last = *s.last;
    if (last < first) throw Error(ErrorKind::Usage, fmt::format("there is no frame from {} to {}", first, last));
    if ((last - first) / s.jump >= most_frames)
      throw Error(ErrorKind::Usage, fmt::format("more than {} frames", most_frames));
    for (int f = first; f <= last; f += s.jump) frames_.push_back(f);
  }

  // All places that anything is at.
  Scene whole() {
    if (!is_animated()) return stage_->scene();
    // The whole animation, whichever frames are asked for: parts of a film are made apart from each other.
    constexpr int poses = 8;
    Scene all;
    for (int i = 0; i < poses; ++i) {
      SceneChoice choice = choice_;
      choice.time = args_.load.choice.time + end_ * i / (poses - 1);
      Scene scene = load_shape(choice);
      const auto before = static_cast<int>(all.meshes.size());
      for (Mesh& mesh : scene.meshes) all.meshes.push_back(std::move(mesh));
      for (Instance instance : scene.instances) instance.mesh += before, all.instances.push_back(instance);
      if (i == 0) all.cameras = scene.cameras;
    }
    return all;
  }

  float4x4 turned(float3 up, float angle) const {
    return translation(centre_) * rotation(up, angle) * translation(-centre_);
  }

  // What the camera sees on its way round, seen from where it starts.
  void add_turns(Scene& all, float3 up) const {
    constexpr int steps = 24;
    const std::vector<Instance> once = all.instances;
    for (int i = 1; i < steps; ++i)
      for (Instance instance : once) {
        instance.world_from_object = turned(up, static_cast<float>(tau * i / steps)) * instance.world_from_object;
        all.instances.push_back(instance);
      }
  }

  const RenderArgs& args_;
  SceneSource& source_;
  SceneChoice choice_;
  double end_ = 0;  // of the animation, in seconds
  std::unique_ptr<Stage> stage_;
  std::optional<TextureSet> textures_;
  std::optional<InterleavedVertices> records_;
  RasterMemory memory_;
  std::vector<int> frames_;
  float3 centre_;
};

// Frames before and after, where a data pass looks at them.
class Neighbours {
 public:
  Neighbours(RenderArgs& args, Plan& plan, const Camera& still, int frame) : options_(args.options) {
    const float aspect = static_cast<float>(args.options.width) / static_cast<float>(args.options.height);
    const auto look = [&](bool Planes::*plane, int at, std::optional<Seen>& seen, const Moment*& moment) {
      moment = nullptr;
      if (std::ranges::none_of(args.aovs, [&](const Aov* aov) { return aov->plane == plane; })) return;
      const Scene& scene = plan.shape(at, seen.emplace().scene);
      seen->moment = {&scene, plan.camera(still, scene, args.view, aspect, at)};
      moment = &seen->moment;
    };
    look(&Planes::motion, frame - args.sequence.jump, last_, options_.last);
    look(&Planes::flow, frame + args.sequence.jump, next_, options_.next);
  }
  ~Neighbours() { options_.last = options_.next = nullptr; }
  Neighbours(const Neighbours&) = delete;
  Neighbours& operator=(const Neighbours&) = delete;

 private:
  struct Seen {
    Scene scene;
    Moment moment;
  };
  RenderOptions& options_;
  std::optional<Seen> last_, next_;
};

// A frame, its shutter open from its moment on.
Rendered render_frame(RenderArgs& args, Plan& plan, const Camera& still, int frame, const std::string& output,
                      Resolver& resolver, Summary& summary) {
  const float aspect = static_cast<float>(args.options.width) / static_cast<float>(args.options.height);
  const int samples = args.sequence.shutter ? args.sequence.shutter_samples : 1;
  const double open = args.sequence.shutter.value_or(0) / 360;
  const auto moment = [&](int i) { return frame + open * (i + 0.5) / samples; };
  Camera camera;
  const auto scene_at = [&](int i) -> const Scene& {
    const double at = samples == 1 ? frame : moment(i);
    Stage& stage = plan.stage(at);
    camera = plan.camera(still, stage.scene(), args.view, aspect, at);
    args.options.environment = stage.light(camera, args.look);
    plan.share(stage.scene(), args.options);
    return stage.scene();
  };
  if (samples > 1) return render_mean(args, samples, scene_at, camera, resolver, summary);
  const Neighbours neighbours(args, plan, still, frame);
  const Scene& scene = scene_at(0);
  return render_picture(args, scene, camera, resolver, output, summary);
}

void check_film(const RenderArgs& args, std::size_t frames) {
  if (!args.aovs.empty()) throw Error(ErrorKind::Usage, "--aov wants numbered frames, as chair.####.png");
  const std::uint64_t bytes = std::uint64_t{4} * frames * static_cast<std::uint64_t>(args.options.width) *
                              static_cast<std::uint64_t>(args.options.height);
  if (!is_encoded_by_ffmpeg(args.output) && bytes > args.load.limits.memory)
    throw Error(ErrorKind::Failed,
                fmt::format("{}: a film of {} frames needs {} MB of memory, --max-memory allows {} MB", args.input,
                            frames, bytes >> 20, args.load.limits.memory >> 20));
}

bool is_one_frame(const SequenceArgs& s) { return s.count == 1 || (s.first && s.first == s.last); }

}  // namespace

bool is_film(const std::string& output) {
  const std::string extension = extension_of(output);
  return extension == ".apng" || extension == ".gif" || extension == ".mp4" || extension == ".webm" ||
         extension == ".webp";
}

void render_sequence(RenderArgs args, Resolver& resolver, ItemSender& out, Summary& summary) {
  const bool has_number = has_frame_number(args.output);
  if (!has_number && !is_film(args.output) && !is_one_frame(args.sequence))
    throw Error(ErrorKind::Usage,
                args.output +
                    ": several frames want a place for their number, as chair.####.png, or a film: .apng, "
                    ".webp, .gif, .mp4, .webm");
  SceneSource source(args.input, args.load);
  Plan plan(args, source);
  out.has_read();
  const bool is_numbered = has_number || !is_film(args.output);
  summary.warnings = plan.stage(plan.frames().front()).scene().warnings;
  args.view.up = args.up.value_or(plan.stage(plan.frames().front()).scene().up);
  const float aspect = static_cast<float>(args.options.width) / static_cast<float>(args.options.height);
  if (!is_numbered) check_film(args, plan.frames().size());
  const Camera still = plan.still_camera(args.view, aspect);

  Animation film = film_of(args.sequence.rate);
  Background background;
  std::size_t done = 0;
  for (const int frame : plan.frames()) {
    out.progress("render", static_cast<double>(done++) / static_cast<double>(plan.frames().size()));
    const std::string output = is_numbered ? output_path(args, frame, -1) : args.output;
    if (is_numbered && args.skip_existing && exists(output)) continue;
    Rendered picture = render_frame(args, plan, still, frame, output, resolver, summary);
    if (is_numbered) {
      const auto send = [&out, picture = std::make_shared<Rendered>(std::move(picture)), output, frame] {
        out.file(frame, -1, encode_picture(*picture, output));
        for (const LayerFile& file : picture->layers) out.file(frame, file.aov, file.bytes);
      };
      // PNG takes all threads by itself.
      if (extension_of(output) == ".png")
        send();
      else
        background.run(send);
    } else if (is_encoded_by_ffmpeg(output)) {
      out.film_frame(picture.image);
    } else {
      film.has_alpha = picture.has_alpha;
      film.frames.push_back(std::move(picture.image));
    }
  }
  background.wait();
  summary.frames = static_cast<int>(plan.frames().size());
  if (!film.frames.empty()) out.file(-1, -1, encode_film(film, args.output));
}

}  // namespace zoneplate::cli
