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
#include <string_view>
#include <utility>
#include <vector>

#include "members.h"
#include "zoneplate/base/error.h"
#include "zoneplate/capi/arrays.h"
#include "zoneplate/capi/handles.h"
#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/job/option/values.h"
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
  void operator()(zoneplate_job* job) const { zoneplate_job_free(job); }
};
using ScenePointer = std::unique_ptr<zoneplate_scene, Free>;
using ImagePointer = std::unique_ptr<zoneplate_image, Free>;
using JobPointer = std::unique_ptr<zoneplate_job, Free>;

/// What the last answer points to.
std::vector<ImagePointer>& held() {
  static std::vector<ImagePointer> images;
  return images;
}

/// Sizes have 32 bits here, and the image and the tables of a scene need memory in addition to its file.
constexpr const char* default_memory = "1G";
constexpr std::uint64_t max_memory = std::numeric_limits<std::int32_t>::max();

/// The rows that cannot act in a worker, which has one thread and one instruction set, and no child process.
constexpr std::string_view refused[] = {"threads", "isa", "sandbox"};

using Rows = std::vector<std::pair<std::string, std::optional<std::string>>>;

/// The rows of the table of options that a request sets: [[NAME, TEXT or null], ...].
Rows rows_of(const Input& request) {
  Rows out;
  for (const Input& row : request.at("rows"))
    out.emplace_back(row.at(0), row.at(1).is_null() ? std::nullopt : std::optional(row.at(1).get<std::string>()));
  return out;
}

JobPointer job_of(const Rows& rows) {
  zoneplate_job* made = nullptr;
  check(zoneplate_job_new(&made));
  JobPointer job(made);
  check(zoneplate_job_set(made, "max-memory", default_memory));
  for (const auto& [name, text] : rows) {
    if (std::ranges::find(refused, name) != std::end(refused))
      throw Error(ErrorKind::Usage, name + ": is an option of the program zoneplate, not of this package");
    check(zoneplate_job_set(made, name.c_str(), text ? text->c_str() : nullptr));
    if (name == "max-memory" && parse_bytes(text.value_or("")) > max_memory)
      throw Error(ErrorKind::Usage, fmt::format("max-memory: is {}, expected at most 2 GiB", *text));
  }
  return job;
}

ScenePointer load(const Input& request, const zoneplate_job& job) {
  zoneplate_scene* out = nullptr;
  check(zoneplate_job_load(&job, request.at("model").get<std::string>().c_str(), &out));
  return ScenePointer(out);
}

/// The pose of a camera that takes the place of the job's view, if it is given.
std::optional<zoneplate_camera> camera_of(const Input& request) {
  if (!request.contains("camera")) return std::nullopt;
  Members pose(request.at("camera"), "camera");
  const auto matrix = pose.numbers<double>("matrix", 16);
  if (!matrix) throw Error(ErrorKind::Usage, "camera: requires matrix");
  const std::optional<double> height = pose.number("height");
  constexpr double degree = 3.14159265358979323846 / 180;
  zoneplate_camera out{.size = sizeof out};
  std::copy(matrix->begin(), matrix->end(), out.world_from_camera);
  out.is_orthographic = height ? 1 : 0;
  out.vertical_fov = pose.number("verticalFov").value_or(30) * degree, out.half_height = height ? *height / 2 : 1;
  out.near = pose.number("near").value_or(0.01);
  out.far = pose.number("far").value_or(height ? 1000 : std::numeric_limits<double>::infinity());
  pose.finish();
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
  const JobPointer job = job_of(rows_of(request));
  const ScenePointer scene = load(request, *job);
  const std::optional<zoneplate_camera> camera = camera_of(request);
  Members members(request.at("form"), "render");
  const auto form = static_cast<zoneplate_form>(members.chosen("dtype", {"uint8", "uint16", "float32"}));
  const std::string output = members.text("output").value_or("png");
  members.finish();
  zoneplate_image* image = nullptr;
  check(zoneplate_job_render(job.get(), scene.get(), camera ? &*camera : nullptr, form, &image));
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

/// Writes the files of the command's `render`, below `request.output` of the module's memory.
Json::Object save(const Input& request) {
  const JobPointer job = job_of(rows_of(request));
  const ScenePointer scene = load(request, *job);
  check(zoneplate_job_save(job.get(), scene.get(), request.at("output").get<std::string>().c_str()));
  return {{"warnings", warnings_of(*scene)}};
}

/// The rows of the table of options.
Json::Array option_rows() {
  constexpr const char* kinds[] = {"switch", "number", "whole", "choice", "text"};
  Json::Array out;
  zoneplate_option o{.size = sizeof o};
  for (std::size_t i = 0; zoneplate_job_option(i, &o) == ZONEPLATE_OK; ++i)
    if (std::ranges::find(refused, o.name) == std::end(refused))
      out.push_back(Json::Object{{"name", o.name},
                                 {"value", o.value},
                                 {"kind", kinds[o.kind]},
                                 {"low", o.low},
                                 {"high", o.high},
                                 {"choices", o.choices},
                                 {"group", o.group},
                                 {"summary", o.summary},
                                 {"names", o.names}});
  return out;
}

Json::Object info(const Input& request) {
  const Rows rows = rows_of(request);
  zoneplate_option o{.size = sizeof o};
  for (std::size_t i = 0; zoneplate_job_option(i, &o) == ZONEPLATE_OK; ++i)
    for (const auto& [name, text] : rows)
      if (name == o.name && std::string_view(o.group) != "Input" && std::string_view(o.group) != "Running")
        throw Error(ErrorKind::Usage, name + ": is an option of render, not of info");
  const ScenePointer scene = load(request, *job_of(rows));
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
  out.emplace_back("options", option_rows());
  return out;
}

Json::Object answer(const char* text) {
  struct Verb {
    const char* name;
    Json::Object (*run)(const Input&);
  };
  constexpr Verb verbs[] = {{"render", render}, {"save", save}, {"info", info}, {"compare", compare}, {"list", list}};
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
