// SPDX-License-Identifier: Apache-2.0
// The functions that the page of the playground calls: a scene, and its images by the options of the command.
#include <emscripten/emscripten.h>
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "answer.h"
#include "figures.h"
#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/job/check.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/job/options.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/job/sequence.h"
#include "zoneplate/render/view.h"
#include "zoneplate/report/json.h"
#include "zoneplate/scene/builtin/make.h"
#include "zoneplate/shade/environment/studio.h"
#include "zoneplate/upscale/upscaler.h"

// clang-format off
EM_JS(int, count_threads, (), { return Module.threads ?? 1; });
// clang-format on

namespace zoneplate {

int threads_of_page() {
  static const int threads = count_threads();
  return threads;
}

namespace {

constexpr int turntable_frames = 240;
constexpr int max_warm_up = 32;
constexpr const char* cache = "/cache";  ///< folder of prepared environments in the module's memory

template <class Row>
Json::Object row_of(const Row& row) {
  return {{"name", row.name}, {"summary", row.summary}, {"source", row.source}, {"params", params_of(row.params)}};
}

/// The options of a job, of which the page refuses those that cannot act in it.
std::vector<Option> page_options(Job& job) {
  std::vector<Option> out = job_options(job);
  for (Option& option : reading_options(job.load.limits, "Running", "an image")) out.push_back(std::move(option));
  refuse_rows(out, "threads isa max-memory", "the page chooses it");
  refuse_rows(out, "allow-path", "the page has no files but those that are opened in it");
  refuse_rows(out, "bit-depth jpeg-quality webp-quality png-compression exr-compression aov",
              "the page writes no files");
  refuse_rows(out, "frames frame-start frame-end frame-jump warm-up", "the page chooses the frame");
  return out;
}

Json::Array option_rows() {
  constexpr const char* kinds[] = {"switch", "number", "whole", "choice", "text"};
  Job job;
  Json::Array out;
  const std::vector<Option> options = page_options(job);
  for (const Option& option : options) {
    if (option.is_refused) continue;
    out.push_back(Json::Object{{"name", row_name(option)},
                               {"value", option.value},
                               {"kind", kinds[static_cast<int>(option.kind())]},
                               {"low", option.set.low},
                               {"high", option.set.high},
                               {"choices", Json::Array(option.choices.begin(), option.choices.end())},
                               {"group", option.group},
                               {"meaning", without_dashes(options, option.meaning)}});
  }
  return out;
}

/// The scenes, methods and upscalers with their parameters, and the options.
Json::Object catalogue() {
  Json::Array scenes, methods, upscalers;
  for (const BuiltinMaker& scene : builtin_makers())
    scenes.push_back(Json::Object{{"name", scene.name},
                                  {"summary", scene.summary},
                                  {"params", params_of(scene.params)},
                                  {"failure", scene.failure},
                                  {"complaint", scene.complaint}});
  for (const Method& method : antialias::methods()) {
    Json::Object row = row_of(method);
    row.emplace_back("variants", Json::Array(method.variants.begin(), method.variants.end()));
    row.emplace_back("is_reference", method.is_reference);
    methods.push_back(std::move(row));
  }
  for (const Upscaler& upscaler : upscale::upscalers()) upscalers.push_back(row_of(upscaler));
  return {{"scenes", std::move(scenes)},
          {"methods", std::move(methods)},
          {"upscalers", std::move(upscalers)},
          {"figures", figure_rows()},
          {"options", option_rows()}};
}

/// The frames of a job.
struct FramesOfOptions {
  std::string options;                   ///< of the job
  std::optional<PreparedScene> resting;  ///< the scene, if it does not move
  std::unique_ptr<JobFrames> frames;
  int next = 0;  ///< the frame that continues `frames`
};

/// An image, and by what it was rendered.
struct DrawnImage {
  Rgba8Image image;
  RenderCounts counts;
  double ms = 0;
  Job job;  ///< resolved
  std::optional<PreparedScene> scene;
  Camera camera;
};

/// A model, and the image of the job that was rendered last.
class Session {
 public:
  Json::Object open(const std::string& name);
  Json::Object prepare_environment(const std::string& file);
  Json::Object render(const std::string& options, int frame);
  const Rgba8Image& image() const { return drawn_.image; }
  Json::Object samples(int x, int y) const;

 private:
  Job job_of(const std::string& options, bool is_frame) const;
  const PreparedScene& model(const Job& job);
  DrawnImage render_still(Job job, std::unique_ptr<Resolver> method);
  DrawnImage render_frame(const Job& job, std::unique_ptr<Resolver> method, const std::string& options, int frame);

  std::string name_;
  Environments environments_;
  std::vector<std::uint8_t> prepared_;  ///< of the last prepare_environment
  NoFiles sink_;

  std::string model_key_;  ///< of `model_`
  std::optional<PreparedScene> model_;

  FramesOfOptions frames_;
  DrawnImage drawn_;
};

LoadLimits page_limits() { return {.memory = std::uint64_t{1} << 30}; }

/// Filters the image of a file, and returns its key and where the bytes of the environment are, for `set_environment`.
Json::Object Session::prepare_environment(const std::string& file) {
  Job job;
  job.load.limits = page_limits(), job.hdri_file = file, job.cache = cache;
  job.lighting.environment = Environment{};
  std::uint64_t key = 0;
  environments_.complete(job, [&](std::uint64_t of_file, std::span<const std::uint8_t> bytes) {
    key = of_file, prepared_.assign(bytes.begin(), bytes.end());
  });
  return {{"key", environment_name(key)},
          {"at", std::uint64_t{reinterpret_cast<std::uintptr_t>(prepared_.data())}},
          {"size", std::uint64_t{prepared_.size()}}};
}

/// The job of options "name=value", one a line; of switches the name alone.
Job Session::job_of(const std::string& options, bool is_frame) const {
  Job job;
  if (is_frame) job.sequence.first = 0;
  job.input = name_, job.output = "image.png", job.cache = cache;
  job.load.limits = page_limits();
  const std::vector<Option> table = page_options(job);
  std::istringstream lines(options);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find('=');
    const std::string value = end == line.npos ? "" : line.substr(end + 1);
    set_row(table, line.substr(0, end), end == line.npos ? nullptr : value.c_str());
  }
  naming_rows(table, [&] {
    check_effects(job);
    check_job(job);
  });
  return job;
}

/// The model at rest, with the materials of a job.
const PreparedScene& Session::model(const Job& job) {
  if (const std::string key = model_key(job); !model_ || key != model_key_) {
    model_.reset();
    Scene scene;
    within_import_time(job.input, job.load.limits, [&] { scene = load_scene(job.input, job.load); });
    convert_materials(job, scene);
    model_.emplace(std::move(scene), job.mips);
    model_key_ = key;
  }
  return *model_;
}

/// Takes a built-in scene, or a model of the working directory of the module's memory.
Json::Object Session::open(const std::string& name) {
  frames_ = {}, drawn_ = {}, model_.reset();
  name_ = name;
  const Job job = job_of("", false);
  const Scene& scene = model(job).scene();
  const bool moves = !scene.animations.empty(), has_own_camera = is_builtin_scene(name) && !scene.cameras.empty();
  std::uint64_t triangles = 0;
  for (const Instance& instance : scene.instances)
    triangles += scene.meshes[static_cast<std::size_t>(instance.mesh)].index.size() / 3;
  AutoFit fit;
  const View view = facing_front(scene, {.up = scene.up}, 4 / 3.0f);
  fit.azimuth = view.azimuth.value_or(fit.azimuth), fit.elevation = view.elevation.value_or(fit.elevation);
  constexpr float degrees = 180 / 3.14159265f;
  const double last = moves ? static_cast<double>(scene.animations[0].end) * job.sequence.rate + 1e-6 : 0;
  return {{"name", name_},
          {"has_own_camera", has_own_camera},
          {"azimuth", has_own_camera ? 0 : fit.azimuth * degrees},
          {"elevation", has_own_camera ? 0 : fit.elevation * degrees},
          {"view_angle", (has_own_camera ? scene.cameras[0].vertical_fov : fit.vertical_fov) * degrees},
          {"is_orthographic", has_own_camera && scene.cameras[0].is_orthographic},
          {"moves", moves},
          {"frames", moves ? static_cast<int>(last) + 1 : turntable_frames},
          {"frame_rate", job.sequence.rate},
          {"triangles", triangles},
          {"warnings", Json::Array(scene.warnings.begin(), scene.warnings.end())}};
}

DrawnImage Session::render_still(Job job, std::unique_ptr<Resolver> method) {
  if (job.sequence.requests_frames())
    throw Error(ErrorKind::Usage, "turntable, views and camera-path are of frames, and this is a still image");
  LitStill still = light_still(job, model(job), false);
  Renderer renderer(still.scene, std::move(method));
  const Stopwatch watch;
  RenderedImage image = renderer.render_still(still.camera, settings_of(still.job, still.job.output));
  return {std::move(image.display), image.counts,           watch.ms(),
          std::move(still.job),     std::move(still.scene), still.camera};
}

/// A method with history gets the frames before this one, if they are not those that were rendered last, but at most
/// `max_warm_up`.
DrawnImage Session::render_frame(const Job& job, std::unique_ptr<Resolver> method, const std::string& options,
                                 int frame) {
  const bool has_history = method->has_history();
  if (!frames_.frames || frames_.options != options) {
    frames_ = {.options = options, .resting = model(job), .frames = nullptr, .next = -1};
    const PreparedScene& scene = *frames_.resting;
    frames_.frames =
        std::make_unique<JobFrames>(job, std::move(method), sink_, scene.scene().animations.empty() ? &scene : nullptr);
  }
  JobFrames& frames = *frames_.frames;
  if (frame != frames_.next) frames.seek(frame, has_history ? std::min(frame, max_warm_up) : 0);
  const Stopwatch watch;
  JobImage image = frames.next();
  frames_.next = frame + 1;
  return {
      std::move(image.image.display), image.image.counts, watch.ms(), frames.job(), frames.prepared(), image.camera};
}

/// Renders a frame of the sequence, or a still image for -1.
Json::Object Session::render(const std::string& options, int frame) {
  Job job = job_of(options, frame >= 0);
  complete_environments(environments_, job, {}, sink_);
  std::unique_ptr<Resolver> method = upscale::make_method(job.method);
  const bool has_history = method->has_history();
  check_request(job, request_of(job, *method));
  drawn_ = frame < 0 ? render_still(std::move(job), std::move(method))
                     : render_frame(job, std::move(method), options, frame);
  return {{"ms", drawn_.ms},
          {"width", drawn_.image.width()},
          {"height", drawn_.image.height()},
          {"has_history", has_history},
          {"shaded", drawn_.counts.shaded},
          {"triangles", drawn_.counts.triangles}};
}

Json::Array rgb_of(const Rgba8& c) { return {Json(int{c.r}), Json(int{c.g}), Json(int{c.b})}; }

/// The samples that the method takes in one pixel of the image, in its first round, and their weighted mean.
Json::Object Session::samples(int x, int y) const {
  const auto& [image, counts, ms, job, scene, camera] = drawn_;
  if (!scene || x < 0 || y < 0 || x >= image.width() || y >= image.height()) return {};
  Json::Object out{{"pixel", rgb_of(image(x, y))}};
  const auto without_samples = [&](const char* reason) {
    out.emplace_back("reason", reason);
    return out;
  };
  const std::unique_ptr<Resolver> method = upscale::make_method(job.method);
  RenderOptions options = settings_of(job, job.output).options;
  Request request = method->request(
      {.image = {options.width, options.height, options.crop}, .camera = camera, .last_camera = camera});
  if (request.draw) return without_samples("The method has its own rasterization: its result is no mean of samples.");
  if (method->has_history())
    return without_samples("The method averages frames, whose samples lie at other positions each time.");
  if (request.frame) return without_samples("The method renders fewer pixels than the image has.");
  if (camera.lens && camera.lens->is_distorted())
    return without_samples("The lens warps the image after its samples are taken.");
  if (request.content != Content::Colour) return without_samples("The first round of the method has no colours.");
  request.planes = {.samples = true};
  request.resolves_per_pixel = false;
  request.halo = 0;
  const Crop whole = options.crop.value_or(Crop{0, 0, options.width, options.height});
  options.crop = Crop{whole.x + x, whole.y + y, 1, 1};
  const Frame frame = zoneplate::render(*scene, camera, request, options);

  const auto count = static_cast<int>(request.samples.size());
  LinearImage colors(count, 1), means(count, 1);
  Linear sum{0, 0, 0, 0};
  float weights = 0;
  Json::Array list;
  for (int i = 0; i < count; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const float weight = request.weights.empty() ? 1.0f : request.weights[s];
    const Linear c = frame.sample_color[s](0, 0);
    sum = sum + c * weight, weights += weight;
    colors(i, 0) = c, means(i, 0) = weights == 0 ? Linear{0, 0, 0, 0} : sum * (1 / weights);
  }
  const Rgba8Image shown = quantize8(make_display(colors, options.display));
  const Rgba8Image shown_means = quantize8(make_display(means, options.display));
  for (int i = 0; i < count; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const Linear c = colors(i, 0);
    const std::uint32_t triangle = frame.sample_triangle[s](0, 0);
    list.push_back(Json::Object{{"x", int{request.samples[s].x}},
                                {"y", int{request.samples[s].y}},
                                {"triangle", triangle == Frame::no_id ? Json() : Json(std::uint64_t{triangle})},
                                {"weight", request.weights.empty() ? 1.0f : request.weights[s]},
                                {"linear", Json::Array{c.r, c.g, c.b, c.a}},
                                {"color", rgb_of(shown(i, 0))},
                                {"mean", rgb_of(shown_means(i, 0))}});
  }
  out.emplace_back("samples", std::move(list));
  out.emplace_back("shades_samples", request.rate == Rate::Sample);
  return out;
}

}  // namespace
}  // namespace zoneplate

using namespace zoneplate;

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* list_catalogue() { return answer(catalogue); }

EMSCRIPTEN_KEEPALIVE Session* make_session() { return new Session; }

/// The name of the prepared studio in the cache, where its bytes are written: to make it takes seconds.
EMSCRIPTEN_KEEPALIVE const char* name_studio(Session*) {
  return answer([] { return Json::Object{{"key", environment_name(studio_key_number())}}; });
}

EMSCRIPTEN_KEEPALIVE const char* prepare_environment(Session* session, const char* file) {
  return answer([&] { return session->prepare_environment(file); });
}

EMSCRIPTEN_KEEPALIVE const char* open_model(Session* session, const char* name) {
  return answer([&] { return session->open(name); });
}

/// By options "name=value", one a line.
EMSCRIPTEN_KEEPALIVE const char* render_frame(Session* session, const char* options, int frame) {
  return answer([&] { return session->render(options, frame); });
}

EMSCRIPTEN_KEEPALIVE const char* samples_of(Session* session, int x, int y) {
  return answer([&] { return session->samples(x, y); });
}

/// The image that was rendered last: four bytes for each pixel.
EMSCRIPTEN_KEEPALIVE const std::uint8_t* pixels_of(Session* session) { return &session->image().values().data()->r; }
}
