// SPDX-License-Identifier: Apache-2.0
// The functions that the page of the playground calls: a scene, and its image by one method.
#include <emscripten/emscripten.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "answer.h"
#include "figures.h"
#include "look.h"
#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/lower_case.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/obj/obj.h"
#include "zoneplate/formats/ply/ply.h"
#include "zoneplate/formats/stl/stl.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/sequence.h"
#include "zoneplate/render/view.h"
#include "zoneplate/report/json.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/builtin/make.h"
#include "zoneplate/scene/default_options.h"
#include "zoneplate/shade/environment/layout.h"
#include "zoneplate/shade/environment/prepared_environment.h"
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

constexpr double frame_rate = 24;
constexpr int turntable_frames = 240;
constexpr int max_warm_up = 32;
constexpr int no_frame = -1;

template <class Row>
Json::Object row_of(const Row& row) {
  return {{"name", row.name}, {"summary", row.summary}, {"source", row.source}, {"params", params_of(row.params)}};
}

/// The scenes, methods and upscalers with their parameters.
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
          {"look", Json::Array{Json::Object{{"name", "look"}, {"summary", ""}, {"params", params_of(look_params())}}}}};
}

/// What `body` returns, on one thread: files and decoded images are those of the module's first thread.
template <class Body>
auto on_one_thread(const Body& body) {
  std::optional<decltype(body())> out;
  with_threads(1, [&] { out.emplace(body()); });
  return std::move(*out);
}

/// A scene, its camera, and the image of one method.
class Session {
 public:
  void set_studio(std::span<const std::uint8_t> bytes);
  Json::Object prepare_environment(const std::string& file);
  void set_environment(std::span<const std::uint8_t> bytes);
  void set_builtin(const std::string& text);
  void set_model(const std::string& file);
  void set_view(const View& view, int width, int height);
  Json::Object render(const std::string& method, const std::string& look, int frame);
  const Rgba8Image& image() const { return image_; }
  Json::Object about() const;
  Json::Object samples(int x, int y) const;

 private:
  const Scene& scene() const { return still_->scene(); }
  RenderSettings settings() const;
  Scene lit(Scene scene);
  void set_scene(Scene made, const std::string& name, std::optional<SceneLoader> loader);
  Camera still_camera() const;

  std::shared_ptr<const PreparedEnvironment> studio_;       ///< null: made when a scene needs it
  std::shared_ptr<const PreparedEnvironment> environment_;  ///< of a file, in place of that of any scene; or null
  std::vector<std::uint8_t> prepared_;                      ///< of the last prepare_environment
  std::string name_;
  bool is_builtin_ = false, has_own_camera_ = false, moves_ = false;
  std::optional<PreparedScene> still_;
  std::unique_ptr<Sequence> sequence_;
  bool has_sequence_view_ = false;
  View view_;
  int width_ = 640, height_ = 360;
  float4 background_ = default_background;
  ToneMapping tone_mapping_ = ToneMapping::None;  ///< that goes with the light
  float light_dimming_ = 1;                       ///< of the lights of a file (dimming_of)

  std::string method_, look_;
  std::unique_ptr<Renderer> renderer_;  ///< of `method_`; null: none yet for this scene
  bool has_history_ = false;            ///< of `method_`
  int next_frame_ = no_frame;           ///< that continues the renderer's sequence
  Camera camera_;                       ///< of `image_`
  Rgba8Image image_;
};

/// Takes the prepared studio, so that it is not made anew, which takes seconds.
void Session::set_studio(std::span<const std::uint8_t> bytes) {
  std::optional<PreparedEnvironment> found = PreparedEnvironment::from_bytes(bytes);
  if (!found) throw Error(ErrorKind::Input, "studio.env is of another version");
  studio_ = std::make_shared<const PreparedEnvironment>(std::move(*found));
}

LoadLimits page_limits() { return {.memory = std::uint64_t{1} << 30}; }

/// Filters the image of a file, and returns where the bytes of the environment are, for `set_environment`.
Json::Object Session::prepare_environment(const std::string& file) {
  const CubeImage cube = on_one_thread([&] {
    const FileBytes bytes(file, page_limits().memory);
    if (!is_hdr(bytes.bytes())) throw Error(ErrorKind::Input, file + ": is no Radiance image (.hdr)");
    const TexelImage image = decode_image(bytes.bytes(), file, page_limits().pixels).whole();
    return cube_of(image, layout_of(image.width(), image.height()));
  });
  prepared_ = PreparedEnvironment(cube).bytes();
  return {{"at", std::uint64_t{reinterpret_cast<std::uintptr_t>(prepared_.data())}},
          {"size", std::uint64_t{prepared_.size()}}};
}

/// Takes a prepared environment for the scenes that are set from now on; without bytes they have their own light.
void Session::set_environment(std::span<const std::uint8_t> bytes) {
  environment_ = nullptr;
  if (std::optional<PreparedEnvironment> found = PreparedEnvironment::from_bytes(bytes))
    environment_ = std::make_shared<const PreparedEnvironment>(std::move(*found));
}

/// The scene under the lights that the command `render` gives it.
Scene Session::lit(Scene scene) {
  LightingOptions options;
  if (environment_) options.environment = Environment{.color = {1, 1, 1}, .map = environment_};
  if (studio_) options.studio = [this] { return studio_; };
  Lighting lighting = make_lighting(scene, options);
  scene.lights = std::move(lighting.lights);
  for (Light& light : scene.lights) light.intensity *= light_dimming_;
  scene.environment = lighting.environment;
  scene.ambient_light = lighting.ambient_light;
  tone_mapping_ = lighting.tone_mapping;
  return scene;
}

/// Takes a scene that was made; `loader` makes it at other times, if it moves.
void Session::set_scene(Scene made, const std::string& name, std::optional<SceneLoader> loader) {
  name_ = name;
  background_ = name == "triangles" ? float4{0, 0, 0, 1} : default_background;
  moves_ = loader.has_value();
  renderer_.reset();
  sequence_.reset();
  light_dimming_ = 1;
  still_.emplace(lit(std::move(made)));
  if (!environment_) light_dimming_ = dimming_of(*still_, upscale::make_method("none")).factor;
  *still_ = dimmed(std::move(*still_), light_dimming_);
  if (loader) {
    const SequenceTiming timing{.rate = frame_rate, .duration = static_cast<double>(scene().animations[0].end)};
    sequence_ = std::make_unique<Sequence>(std::move(*loader), MipOptions{}, timing);
  } else {
    sequence_ = std::make_unique<Sequence>(*still_, SequenceTiming{.rate = frame_rate, .turntable = turntable_frames});
  }
  has_sequence_view_ = false;
}

void Session::set_builtin(const std::string& text) {
  std::optional<Scene> made = make_builtin_scene(text);
  if (!made) throw Error(ErrorKind::Usage, text + ": no scene of this name");
  is_builtin_ = true, has_own_camera_ = !made->cameras.empty();
  std::optional<SceneLoader> loader;
  if (!made->animations.empty() && text.find(':') == std::string::npos) {
    const auto load = [this, text](double seconds) {
      return lit(*make_builtin_scene(fmt::format("{}:time={:.6f}", text, std::clamp(seconds, 0.0, 10.0))));
    };
    loader = {load, load};
  }
  set_scene(std::move(*made), text, std::move(loader));
}

/// Takes a model of the working directory of the module's memory.
void Session::set_model(const std::string& file) {
  const LoadLimits limits = page_limits();
  const std::string extension = lower_case(file.substr(std::min(file.rfind('.'), file.size())));
  Scene made;
  std::optional<SceneLoader> loader;
  if (extension == ".glb" || extension == ".gltf" || extension == ".vrm") {
    const auto model = on_one_thread([&] { return std::make_shared<GltfModel>(file, limits); });
    const auto scene_at = [model](const SceneChoice& choice, GltfModel::Images images) {
      return on_one_thread([&] { return model->scene(choice, images); });
    };
    made = scene_at({}, GltfModel::Images::With);
    if (!made.animations.empty())
      loader = {[this, scene_at](double seconds) {
                  return lit(scene_at({.animation = 0, .time = seconds}, GltfModel::Images::With));
                },
                [scene_at](double seconds) {
                  return scene_at({.animation = 0, .time = seconds}, GltfModel::Images::Without);
                },
                [model] { return on_one_thread([&] { return model->key_times({.animation = 0}); }); }};
  } else if (extension == ".obj") {
    made = on_one_thread([&] { return load_obj(file, limits); });
  } else if (extension == ".ply") {
    made = on_one_thread([&] { return load_ply(file, limits); });
  } else if (extension == ".stl") {
    made = on_one_thread([&] { return load_stl(file, limits); });
  } else {
    throw Error(ErrorKind::Usage, file + ": the page reads .glb, .gltf, .vrm, .obj, .ply and .stl");
  }
  is_builtin_ = false, has_own_camera_ = false;
  set_scene(std::move(made), file, std::move(loader));
}

void Session::set_view(const View& view, int width, int height) {
  view_ = view;
  view_.up = scene().up;
  if (has_own_camera_) view_.index = 0;
  width_ = width, height_ = height;
  has_sequence_view_ = false;
}

Camera Session::still_camera() const {
  return choose_camera(scene(), view_, static_cast<float>(width_) / static_cast<float>(height_));
}

RenderSettings Session::settings() const {
  RenderSettings out;
  out.options.width = width_, out.options.height = height_;
  // What the command `render` chooses where its user does not.
  out.options.anisotropy = is_builtin_ ? 1 : default_anisotropy;
  out.options.point_size = default_point_size(scene(), width_, height_);
  out.options.display.background = background_;
  out.options.display.mapping = tone_mapping_;
  set_look(look_, out.options);
  return out;
}

Json::Object Session::about() const {
  const int frames = !moves_ ? turntable_frames : static_cast<int>(scene().animations[0].end * frame_rate + 1e-6f) + 1;
  std::uint64_t triangles = 0;
  for (const Instance& instance : scene().instances)
    triangles += scene().meshes[static_cast<std::size_t>(instance.mesh)].index.size() / 3;
  AutoFit fit;
  const View view = facing_front(scene(), {.up = scene().up}, 4 / 3.0f);
  fit.azimuth = view.azimuth.value_or(fit.azimuth), fit.elevation = view.elevation.value_or(fit.elevation);
  constexpr float degrees = 180 / 3.14159265f;
  return {{"name", name_},
          {"has_own_camera", has_own_camera_},
          {"azimuth", has_own_camera_ ? 0 : fit.azimuth * degrees},
          {"elevation", has_own_camera_ ? 0 : fit.elevation * degrees},
          {"view_angle", (has_own_camera_ ? scene().cameras[0].vertical_fov : fit.vertical_fov) * degrees},
          {"is_orthographic", has_own_camera_ && scene().cameras[0].is_orthographic},
          {"moves", moves_},
          {"frames", frames},
          {"frame_rate", frame_rate},
          {"triangles", triangles},
          {"warnings", Json::Array(scene().warnings.begin(), scene().warnings.end())}};
}

/// Renders a frame of the sequence, or a still image for -1. A method with history gets the frames before it, if they
/// are not those that were rendered last, but at most `max_warm_up`.
Json::Object Session::render(const std::string& method, const std::string& look, int frame) {
  if (!renderer_ || method_ != method) {
    std::unique_ptr<Resolver> resolver = upscale::make_method(method);
    has_history_ = resolver->has_history();
    renderer_ = std::make_unique<Renderer>(*still_, std::move(resolver));
    method_ = method, next_frame_ = no_frame;
  }
  look_ = look;
  Stopwatch watch;
  RenderedImage out;
  if (frame < 0) {
    renderer_->set_scene(*still_);
    camera_ = still_camera();
    out = renderer_->render_still(camera_, settings());
    next_frame_ = no_frame;
  } else {
    if (!has_sequence_view_) {
      sequence_->set_view(view_, static_cast<float>(width_) / static_cast<float>(height_));
      has_sequence_view_ = true;
    }
    const bool continues = frame == next_frame_;
    if (!continues) renderer_->begin_sequence();
    for (int f = continues || !has_history_ ? frame : std::max(0, frame - max_warm_up); f <= frame; ++f) {
      SceneView view = sequence_->view(f);
      renderer_->set_scene(std::move(view.scene));
      camera_ = view.camera;
      watch = {};
      out = renderer_->render(camera_, settings());
    }
    next_frame_ = frame + 1;
  }
  image_ = std::move(out.display);
  return {{"ms", watch.ms()},
          {"width", image_.width()},
          {"height", image_.height()},
          {"has_history", has_history_},
          {"shaded", out.counts.shaded},
          {"triangles", out.counts.triangles}};
}

Json::Array rgb_of(const Rgba8& c) { return {Json(int{c.r}), Json(int{c.g}), Json(int{c.b})}; }

/// The samples that the method takes in one pixel of the image, in its first round, and their weighted mean.
Json::Object Session::samples(int x, int y) const {
  if (!renderer_ || x < 0 || y < 0 || x >= image_.width() || y >= image_.height()) return {};
  Json::Object out{{"pixel", rgb_of(image_(x, y))}};
  const auto without_samples = [&](const char* reason) {
    out.emplace_back("reason", reason);
    return out;
  };
  const std::unique_ptr<Resolver> method = upscale::make_method(method_);
  Request request = method->request({.image = {width_, height_, {}}, .camera = camera_, .last_camera = camera_});
  if (request.draw) return without_samples("The method has its own rasterization: its result is no mean of samples.");
  if (method->has_history())
    return without_samples("The method averages frames, whose samples lie at other positions each time.");
  if (request.frame) return without_samples("The method renders fewer pixels than the image has.");
  if (request.content != Content::Colour) return without_samples("The first round of the method has no colours.");
  request.planes = {.samples = true};
  request.resolves_per_pixel = false;
  request.halo = 0;
  RenderOptions options = settings().options;
  options.crop = Crop{x, y, 1, 1};
  const Frame frame = zoneplate::render(renderer_->scene(), camera_, request, options);

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

EMSCRIPTEN_KEEPALIVE const char* set_studio(Session* session, const std::uint8_t* bytes, std::size_t size) {
  return answer([&] {
    session->set_studio({bytes, size});
    return Json::Object{};
  });
}

EMSCRIPTEN_KEEPALIVE const char* prepare_environment(Session* session, const char* file) {
  return answer([&] { return session->prepare_environment(file); });
}

EMSCRIPTEN_KEEPALIVE const char* set_environment(Session* session, const std::uint8_t* bytes, std::size_t size) {
  return answer([&] {
    session->set_environment({bytes, size});
    return Json::Object{};
  });
}

EMSCRIPTEN_KEEPALIVE const char* set_builtin(Session* session, const char* text) {
  return answer([&] {
    session->set_builtin(text);
    return session->about();
  });
}

EMSCRIPTEN_KEEPALIVE const char* set_model(Session* session, const char* file) {
  return answer([&] {
    session->set_model(file);
    return session->about();
  });
}

/// Angles in degrees; NaN: that of the scene's view.
EMSCRIPTEN_KEEPALIVE const char* set_view(Session* session, int width, int height, double azimuth, double elevation,
                                          double view_angle) {
  return answer([&] {
    const auto radians = [](double degrees) -> std::optional<float> {
      if (std::isnan(degrees)) return std::nullopt;
      return static_cast<float>(degrees * (3.14159265358979323846 / 180));
    };
    session->set_view({.view_angle = radians(view_angle), .azimuth = radians(azimuth), .elevation = radians(elevation)},
                      width, height);
    return Json::Object{};
  });
}

EMSCRIPTEN_KEEPALIVE const char* render_frame(Session* session, const char* method, const char* look, int frame) {
  return answer([&] { return session->render(method, look, frame); });
}

EMSCRIPTEN_KEEPALIVE const char* samples_of(Session* session, int x, int y) {
  return answer([&] { return session->samples(x, y); });
}

/// The image that was rendered last: four bytes for each pixel.
EMSCRIPTEN_KEEPALIVE const std::uint8_t* pixels_of(Session* session) { return &session->image().values().data()->r; }
}
