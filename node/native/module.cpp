// SPDX-License-Identifier: Apache-2.0
// The function that the package for Node and browsers calls, with JSON in both directions. It renders by the interface
// for C, so that names, defaults and bytes are those of the other packages and of the command.
#include <emscripten/emscripten.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "members.h"
#include "zoneplate/base/error.h"
#include "zoneplate/capi/arrays.h"
#include "zoneplate/capi/handles.h"
#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/os/file.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/scene_contents.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/environment/studio.h"
#include "zoneplate/zoneplate.h"

namespace zoneplate {

/// The studio, which the package contains: to make it takes seconds.
PreparedEnvironment prepare_studio() {
  const FileBytes file("/studio.env");
  std::optional<PreparedEnvironment> found = PreparedEnvironment::from_bytes(file.bytes());
  if (!found) throw Error(ErrorKind::Failed, "studio.env is of another version");
  return std::move(*found);
}

namespace node {
namespace {

using Input = nlohmann::json;

/// A failed call of the interface for C.
struct Failure {
  zoneplate_status status;
  std::string text;
};

void check(zoneplate_status status) {
  if (status != ZONEPLATE_OK) throw Failure{status, zoneplate_error_text()};
}

struct Free {
  void operator()(zoneplate_scene* scene) const { zoneplate_scene_free(scene); }
  void operator()(zoneplate_image* image) const { zoneplate_image_free(image); }
};
using ScenePointer = std::unique_ptr<zoneplate_scene, Free>;
using ImagePointer = std::unique_ptr<zoneplate_image, Free>;

/// What the last answer points to.
std::vector<ImagePointer>& held() {
  static std::vector<ImagePointer> images;
  return images;
}

double radians(double degrees) { return degrees * (3.14159265358979323846 / 180); }

/// The sRGB codes in [0, 1] of "#rrggbb", "#rrggbbaa" or of numbers, with alpha.
std::optional<std::vector<float>> color_of(Members& members, const char* name) {
  const Input* const found = members.find(name);
  if (found == nullptr) return std::nullopt;
  constexpr const char* expected = "#rrggbb, #rrggbbaa, or 3 or 4 numbers";
  std::vector<float> out;
  if (found->is_string()) {
    const std::string text = found->get<std::string>();
    if ((text.size() != 7 && text.size() != 9) || text[0] != '#' ||
        text.find_first_not_of("0123456789abcdefABCDEF", 1) != text.npos)
      members.refuse(name, expected);
    for (std::size_t i = 1; i < text.size(); i += 2)
      out.push_back(static_cast<float>(std::stoi(text.substr(i, 2), nullptr, 16)) / 255);
  } else {
    if (!found->is_array() || (found->size() != 3 && found->size() != 4) ||
        !std::all_of(found->begin(), found->end(), [](const Input& item) { return item.is_number(); }))
      members.refuse(name, expected);
    out = found->get<std::vector<float>>();
  }
  if (out.size() == 3) out.push_back(1);
  return out;
}

/// The light of a colour: text is sRGB-encoded, numbers are linear.
std::optional<std::vector<float>> light_of(Members& members, const char* name) {
  std::optional<std::vector<float>> color = color_of(members, name);
  if (color && members.find(name)->is_string())
    for (float& c : *color) c = decode_srgb8(static_cast<std::uint8_t>(c * 255 + 0.5f));
  return color;
}

/// Sizes have 32 bits here, and the image and the tables of a scene need memory in addition to its file.
constexpr double default_memory = 1 << 30, max_memory = std::numeric_limits<std::int32_t>::max();

ScenePointer load(const Input& request) {
  Members members(request.value("load", Input()), "model");
  const std::optional<std::string> format = members.text("format"), variant = members.text("variant");
  const std::optional<std::int32_t> scene = members.whole("scene");
  std::optional<std::int32_t> animation;
  std::optional<std::string> animation_name;
  if (const Input* const found = members.find("animation")) {
    if (found->is_string())
      animation_name = members.text("animation");
    else
      animation = members.whole("animation");
  }
  const double time = members.number("time").value_or(0), memory = members.number("maxMemory").value_or(default_memory);
  const double seconds = members.number("maxSeconds").value_or(0);
  if (!(memory >= 1 && memory <= max_memory)) members.refuse("maxMemory", fmt::format("bytes, 1 to {}", max_memory));
  if (!(seconds >= 0)) members.refuse("maxSeconds", "0 or more");
  members.finish();

  const zoneplate_load_options options{.size = sizeof options,
                                       .format = format ? format->c_str() : nullptr,
                                       .variant = variant ? variant->c_str() : nullptr,
                                       .scene = scene ? &*scene : nullptr,
                                       .animation = animation ? &*animation : nullptr,
                                       .time = time,
                                       .is_sandboxed = 0,
                                       .max_memory = static_cast<std::uint64_t>(memory),
                                       .max_seconds = seconds,
                                       .animation_name = animation_name ? animation_name->c_str() : nullptr};
  zoneplate_scene* out = nullptr;
  check(zoneplate_scene_load(request.at("model").get<std::string>().c_str(), &options, &out));
  return ScenePointer(out);
}

/// The camera of a view of the scene, or that which is given; nothing: the default view of the command.
std::optional<zoneplate_camera> camera_of(const Input& request, const zoneplate_scene& scene, double aspect) {
  Members view(request.value("view", Input()), "view"), pose(request.value("camera", Input()), "camera");
  const std::optional<std::int32_t> index = view.whole("index");
  const auto position = view.numbers<double>("position", 3), focal_point = view.numbers<double>("focalPoint", 3);
  const auto view_up = view.numbers<float>("viewUp", 3);
  const auto angle = [&](const char* name) {
    const std::optional<double> degrees = view.number(name);
    return degrees ? std::optional(static_cast<float>(radians(*degrees))) : std::nullopt;
  };
  const std::optional<float> vertical_fov = angle("verticalFov"), azimuth = angle("azimuth"),
                             elevation = angle("elevation");
  const bool is_orthographic = view.flag("orthographic");
  view.finish();
  const auto matrix = pose.numbers<double>("matrix", 16);
  const std::optional<double> height = pose.number("height");
  const double fov = pose.number("verticalFov").value_or(30), near = pose.number("near").value_or(0.01);
  const double far = pose.number("far").value_or(height ? 1000 : std::numeric_limits<double>::infinity());
  pose.finish();

  zoneplate_camera out{.size = sizeof out};
  if (matrix) {
    std::copy(matrix->begin(), matrix->end(), out.world_from_camera);
    out.is_orthographic = height ? 1 : 0;
    out.vertical_fov = radians(fov), out.half_height = height ? *height / 2 : 1;
    out.near = near, out.far = far;
    return out;
  }
  if (request.value("camera", Input()).is_object()) throw Error(ErrorKind::Usage, "camera: requires matrix");
  if (!request.value("view", Input()).is_object()) return std::nullopt;
  const zoneplate_view chosen{.size = sizeof chosen,
                              .index = index ? &*index : nullptr,
                              .position = position ? position->data() : nullptr,
                              .focal_point = focal_point ? focal_point->data() : nullptr,
                              .view_up = view_up ? view_up->data() : nullptr,
                              .vertical_fov = vertical_fov ? &*vertical_fov : nullptr,
                              .azimuth = azimuth ? &*azimuth : nullptr,
                              .elevation = elevation ? &*elevation : nullptr,
                              .is_orthographic = is_orthographic ? 1 : 0};
  check(zoneplate_scene_camera(&scene, &chosen, aspect, &out));
  return out;
}

Json::Object place_of(const zoneplate_array& array) {
  constexpr const char* types[] = {"uint8", "uint16", "uint32", "int32", "int64", "float32", "float64"};
  Json::Array shape;
  for (int i = 0; i < array.dimensions; ++i) shape.emplace_back(array.shape[i]);
  return {{"at", std::uint64_t{reinterpret_cast<std::uintptr_t>(array.data)}},
          {"type", types[array.type]},
          {"shape", std::move(shape)}};
}

Json::Array warnings_of(const zoneplate_scene& scene) {
  return scene.read([](const Scene& s) { return Json::Array(s.warnings.begin(), s.warnings.end()); });
}

Json::Object render(const Input& request) {
  const ScenePointer scene = load(request);
  Members members(request.value("options", Input()), "render");
  zoneplate_render_options options{.size = sizeof options};
  const auto size = members.numbers<std::int32_t>("size", 2), crop = members.numbers<std::int32_t>("crop", 4);
  if (size && ((*size)[0] < 1 || (*size)[1] < 1)) members.refuse("size", "a width and a height of 1 or more");
  options.width = size ? (*size)[0] : 800, options.height = size ? (*size)[1] : 600;
  const std::optional<std::string> method = members.text("aa"), tone_mapping = members.text("toneMapping");
  options.method = method ? method->c_str() : nullptr;
  options.tone_mapping = tone_mapping ? tone_mapping->c_str() : nullptr;
  std::string passes;
  if (const Input* const aovs = members.find("aovs")) {
    if (!aovs->is_array()) members.refuse("aovs", "a list of names");
    for (const Input& name : *aovs)
      passes += (passes.empty() ? "" : ",") + (name.is_string() ? name.get<std::string>() : name.dump());
  }
  options.passes = passes.c_str();
  options.form = static_cast<zoneplate_form>(members.chosen("dtype", {"uint8", "uint16", "float32"}));
  if (crop) std::copy(crop->begin(), crop->end(), options.crop);
  // A plane of four floats has at most 1 GiB.
  constexpr double max_pixels = 1 << 26;
  const auto& rendered = crop ? std::vector(crop->begin() + 2, crop->end()) : size.value_or(std::vector{800, 600});
  if (static_cast<double>(rendered[0]) * rendered[1] > max_pixels)
    members.refuse(crop ? "crop" : "size", fmt::format("at most {} pixels", max_pixels));
  options.exposure = members.real("exposure").value_or(0);
  const auto background = color_of(members, "background"), environment = light_of(members, "environment");
  options.background = background ? background->data() : nullptr;
  options.environment = environment ? environment->data() : nullptr;
  options.is_transparent = members.flag("transparent") ? 1 : 0;
  const std::optional<float> intensity = members.real("lightIntensity");
  options.light_intensity = intensity ? &*intensity : nullptr;
  options.shadows = static_cast<zoneplate_shadows>(members.chosen("shadows", {"none", "map", "hard", "soft"}));
  options.occlusion_samples = members.whole("ambientOcclusion").value_or(0);
  options.has_shadow_ground = members.flag("shadowGround") ? 1 : 0;
  options.anisotropy = members.whole("anisotropy").value_or(0);
  options.keeps_back_faces = members.flag("cullBackFaces", true) ? 0 : 1;
  options.point_size = members.real("pointSize").value_or(0);
  const std::string output = members.text("output").value_or("png");
  members.finish();
  options.threads = 1;

  const auto camera =
      camera_of(request, *scene, static_cast<double>(options.width) / static_cast<double>(options.height));
  zoneplate_image* image = nullptr;
  check(zoneplate_render(scene.get(), camera ? &*camera : nullptr, &options, &image));
  held().emplace_back(image);
  zoneplate_array color{};
  check(zoneplate_image_array(image, "color", &color));
  Json::Object out{{"width", color.shape[1]}, {"height", color.shape[0]}, {"warnings", warnings_of(*scene)}};
  if (output != "pixels") {
    zoneplate_image* file = nullptr;
    check(zoneplate_image_encode(image, output.c_str(), &file));
    held().emplace_back(file);
    check(zoneplate_image_array(file, "bytes", &color));
  }
  out.emplace_back("data", place_of(color));
  Json::Object arrays;
  for (std::size_t i = 0; i < zoneplate_image_count(image); ++i) {
    const std::string name = zoneplate_image_name(image, i);
    if (name == "color") continue;
    zoneplate_array array{};
    check(zoneplate_image_array(image, name.c_str(), &array));
    arrays.emplace_back(name, place_of(array));
  }
  out.emplace_back("arrays", std::move(arrays));
  return out;
}

Json::Object info(const Input& request) {
  const ScenePointer scene = load(request);
  return scene->read([](const Scene& s) {
    return Json::Object{{"contents", scene_contents(s)}, {"text", scene_contents_text(s)}};
  });
}

/// An image to measure: a file, or an array in the module's memory.
metrics::Picture picture_of(const Input& given, const char* name) {
  metrics::Picture picture;
  if (given.contains("path")) {
    const std::string path = given.at("path");
    if (open_animation(metrics::open_image(path).bytes, path, std::uint64_t{1} << 26))
      throw Error(ErrorKind::Input, path + ": is an animation, whose frames the program zoneplate metrics compares");
    picture = metrics::load_picture(path);
    if (!picture.flaw.empty()) throw Error(ErrorKind::Input, picture.flaw);
  } else {
    constexpr const char* types[] = {"uint8", "uint16"};
    const std::string type = given.at("type");
    const zoneplate_type found = type == types[0]   ? ZONEPLATE_UINT8
                                 : type == types[1] ? ZONEPLATE_UINT16
                                                    : ZONEPLATE_FLOAT32;
    const auto shape = given.at("shape").get<std::vector<std::int64_t>>();
    picture = capi::picture_of(capi::array_of(reinterpret_cast<const void*>(given.at("at").get<std::uintptr_t>()),
                                              found, {shape.at(0), shape.at(1), shape.at(2)}),
                               name);
  }
  if (const std::size_t pixels = metrics::count_not_finite(picture); pixels > 0)
    throw Error(ErrorKind::Input, fmt::format("{}: has {} pixels with NaN or infinite values, expected finite ones",
                                              given.value("path", name), pixels));
  return picture;
}

Json::Object compare(const Input& request) {
  std::vector<metrics::Choice> choices;
  for (const Input& name : request.at("metrics"))
    choices.push_back(
        metrics::choose_metric(metrics::metrics(), name.is_string() ? name.get<std::string>() : name.dump()));
  const bool has_choice = !choices.empty();
  if (!has_choice) choices = metrics::default_choices(metrics::metrics());
  metrics::IgnoredRegions ignored;
  for (const Input& region : request.at("ignore")) {
    const auto r = region.get<std::vector<int>>();
    ignored.rectangles.push_back({r.at(0), r.at(1), r.at(2), r.at(3)});
  }
  const auto reference = [&](std::size_t) {
    metrics::Picture picture = picture_of(request.at("reference"), "reference");
    metrics::mark_ignored(picture, ignored);
    return picture;
  };
  metrics::Comparison found = metrics::compare(
      {.count = 1, .reference = reference, .test = [&](std::size_t) { return picture_of(request.at("test"), "test"); }},
      choices, has_choice ? metrics::Unfit::Refuse : metrics::Unfit::Leave);
  Json::Object values, out{{"identical", found.are_same}, {"width", found.width}, {"height", found.height}};
  bool has_map = false;
  for (metrics::Result& result : found.results) {
    Json::Object figures;
    for (const metrics::Figure& figure : result.score.more) figures.emplace_back(figure.name, figure.value);
    values.emplace_back(std::string(result.metric->name),
                        Json::Object{{"value", result.value},
                                     {"unit", result.metric->unit},
                                     {"better", result.metric->better == metrics::Better::Lower ? "lower" : "higher"},
                                     {"figures", std::move(figures)}});
    if (has_map || result.score.map.empty()) continue;
    auto map = std::make_unique<zoneplate_image>();
    map->add("map", std::move(result.score.map));
    zoneplate_array array{};
    check(zoneplate_image_array(map.get(), "map", &array));
    out.emplace_back("map", place_of(array));
    held().emplace_back(map.release());
    has_map = true;
  }
  out.emplace_back("metrics", std::move(values));
  return out;
}

Json::Object list(const Input&) {
  Json::Object out{{"version", zoneplate_version()}};
  constexpr const char* names[] = {"methods", "metrics", "scenes", "aovs", "kernels"};
  for (std::size_t kind = 0; kind < std::size(names); ++kind) {
    Json::Object rows;
    const char *name = nullptr, *summary = nullptr;
    for (std::size_t i = 0; zoneplate_list(static_cast<zoneplate_catalogue>(kind), i, &name, &summary) == ZONEPLATE_OK;
         ++i)
      rows.emplace_back(name, summary);
    out.emplace_back(names[kind], std::move(rows));
  }
  return out;
}

Json::Object answer(const char* text) {
  struct Verb {
    const char* name;
    Json::Object (*run)(const Input&);
  };
  constexpr Verb verbs[] = {{"render", render}, {"info", info}, {"compare", compare}, {"list", list}};
  const Input request = Input::parse(text);
  const std::string name = request.at("verb");
  for (const Verb& verb : verbs)
    if (name == verb.name) return verb.run(request);
  throw Error(ErrorKind::Usage, name + ": no verb of this name");
}

}  // namespace
}  // namespace node
}  // namespace zoneplate

/// Answers a request; { error, status } for a failure, whose status is that of the interface for C. The text, and the
/// arrays that it points to, are valid until the next call.
extern "C" EMSCRIPTEN_KEEPALIVE const char* zoneplate_answer(const char* request) {
  using namespace zoneplate;
  static std::string text;
  node::held().clear();
  const auto fail = [](int status, const char* error) {
    text = Json(Json::Object{{"error", error}, {"status", status}}).text();
  };
  try {
    text = Json(node::answer(request)).text();
  } catch (const node::Failure& failure) {
    fail(failure.status, failure.text.c_str());
  } catch (const Error& error) {
    fail(static_cast<int>(error.kind()) + 1, error.what());
  } catch (const std::bad_alloc& error) {
    fail(ZONEPLATE_OUT_OF_MEMORY, error.what());
  } catch (const std::exception& error) {
    fail(ZONEPLATE_FAILED, error.what());
  }
  return text.c_str();
}
