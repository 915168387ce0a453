// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/3mf/3mf.h"
#include "zoneplate/formats/amf/amf.h"
#include "zoneplate/formats/assimp/assimp.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/import/import_child.h"
#include "zoneplate/formats/import/scene_bytes.h"
#include "zoneplate/formats/obj/obj.h"
#include "zoneplate/formats/ply/ply.h"
#include "zoneplate/formats/stl/stl.h"
#include "zoneplate/formats/zip/zip.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/library.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate {
namespace {

constexpr SceneFormat formats[] = {
    {".gltf", "glTF 2.0, with its buffers and images"},     {".glb", "glTF 2.0 in one binary file"},
    {".vrm", "VRM avatars, glTF 2.0 in one binary file"},   {".obj", "Wavefront OBJ, with its MTL materials"},
    {".ply", "PLY, ASCII or binary, meshes and points"},    {".stl", "STL, ASCII or binary"},
    {".3mf", "3D Manufacturing Format, with its textures"}, {".amf", "Additive Manufacturing File, plain or zipped"}};

Scene read_gltf(const std::string& path, const LoadOptions& o) { return load_gltf(path, o.limits, o.choice); }

/// Returns the limits; throws if the options choose a scene, variant or animation, which only glTF files have.
const LoadLimits& limits_of(const LoadOptions& o) {
  const SceneChoice& c = o.choice;
  if (c.scene || c.animation || !c.animation_name.empty() || !c.variant.empty())
    throw Error(ErrorKind::Usage, "only glTF files have scenes, variants and animations to choose from");
  return o.limits;
}
Scene read_obj(const std::string& path, const LoadOptions& o) { return load_obj(path, limits_of(o)); }
Scene read_ply(const std::string& path, const LoadOptions& o) { return load_ply(path, limits_of(o)); }
Scene read_stl(const std::string& path, const LoadOptions& o) { return load_stl(path, limits_of(o)); }
Scene read_3mf(const std::string& path, const LoadOptions& o) { return load_3mf(path, limits_of(o)); }
Scene read_amf(const std::string& path, const LoadOptions& o) { return load_amf(path, limits_of(o)); }
using Loader = Scene (*)(const std::string&, const LoadOptions&);
constexpr Loader loaders[] = {read_gltf, read_gltf, read_gltf, read_obj, read_ply, read_stl, read_3mf, read_amf};
static_assert(std::size(loaders) == std::size(formats));

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// The extension that selects the reader.
std::string extension_of(const std::string& name, const std::string& format) {
  if (format.empty()) return lower_case(std::filesystem::path(name).extension().string());
  return lower_case((format.starts_with('.') ? "" : ".") + format);
}

bool has(std::span<const SceneFormat> all, const std::string& extension) {
  return std::any_of(all.begin(), all.end(), [&](const SceneFormat& f) { return f.extension == extension; });
}

/// How a file is read: the extension of its format, and whether assimp reads it.
struct Reader {
  std::string extension;
  bool is_assimp = false;
};

/// The reader by the extension. Where that is not known, binary glTF and ZIP archives, which are taken as 3MF, are
/// known by their first bytes. glTF 1.0 is left to assimp.
///
/// Errors    those of FileBytes.
Reader reader_of(const std::string& name, const LoadOptions& options) {
  std::string extension = extension_of(name, options.format);
  if (has(assimp_formats(), extension)) return {std::move(extension), true};
  std::error_code ignored;
  const bool is_known = has(formats, extension);
  const bool is_gltf = extension == ".gltf" || extension == ".glb" || extension == ".vrm";
  if ((is_known && !is_gltf) || name == "-" || !std::filesystem::is_regular_file(name, ignored))
    return {std::move(extension)};
  const MappedFileWatch watch;
  const FileBytes file(name, options.limits.memory);
  if (!is_known && options.format.empty())
    extension = is_binary_gltf(file.bytes()) ? ".glb" : is_zip(file.bytes()) ? ".3mf" : extension;
  const bool is_assimp = (is_gltf || extension == ".glb") && is_gltf_1(file.bytes());
  if (is_assimp) extension = is_binary_gltf(file.bytes()) ? ".glb" : ".gltf";
  watch.check(name);
  return {std::move(extension), is_assimp};
}

}  // namespace

std::span<const SceneFormat> scene_formats() { return formats; }

bool is_builtin_scene(std::string_view name) {
  const std::string_view stem = name.substr(0, name.find(':'));
  const auto scenes = builtin_scenes();
  return std::any_of(scenes.begin(), scenes.end(), [&](const BuiltinScene& scene) { return scene.name == stem; });
}

namespace {

/// Reads a file of a supported format, or throws an error with the cause.
Scene read_file(const std::string& name, const Reader& reader, const LoadOptions& options) {
  std::string readable;
  for (const SceneFormat& format : formats) readable.append(readable.empty() ? "" : ", ").append(format.extension);
  if (name == "-" && options.format.empty())
    throw Error(ErrorKind::Usage, "standard input requires --format (" + readable + ")");
  const auto& [extension, is_assimp] = reader;
  if (is_assimp) return load_by_assimp(name, extension, limits_of(options));
  for (std::size_t i = 0; i < std::size(formats); ++i)
    if (extension == formats[i].extension) return loaders[i](name, options);

  readable += " and others, see zoneplate list formats";
  if (!options.format.empty())
    throw Error(ErrorKind::Usage, "'" + options.format + "' is not a format that can be read (" + readable + ")");
  std::error_code ignored;
  const bool exists = std::filesystem::exists(name, ignored);
  constexpr std::string_view images[] = {".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tga"};
  if (exists && std::ranges::find(images, extension) != std::end(images))
    throw Error(ErrorKind::Input, name + ": is an image, expected a model; zoneplate filter antialiases images");
  throw Error(ErrorKind::Input, exists ? name + ": not a format that can be read (" + readable + ")"
                                       : name + ": no such file, and no built-in scene of that name");
}

Scene read_watched(const std::string& name, const Reader& reader, const LoadOptions& options) {
  const MappedFileWatch watch;
  Scene scene = read_file(name, reader, options);
  watch.check(name);
  return scene;
}

/// Calls read_watched in a child process with limits of its resources.
Scene read_in_child(const std::string& name, const Reader& reader, const LoadOptions& options) {
  ImportBudget budget(name == "-" ? "standard input" : name, options.limits);
  LimitedChild child(
      budget.file(), child_limits(budget),
      [&](ChildAnswer& answer) {
        const Scene scene = read_watched(name, reader, options);
        write_scene(scene, [&](const void* data, std::size_t size) { answer.write(data, size); });
      },
      [] {
        open_library(Library::OpenExr);
        open_library(Library::Meshoptimizer);
        open_library(Library::Zstd);
      });
  return read_scene([&](void* out, std::size_t size) { child.read(out, size); }, budget);
}

/// A built-in scene that moves, at the chosen time, in microseconds.
Scene moment_of_builtin(const std::string& name, const SceneChoice& choice) {
  if (name.find(':') != std::string::npos)
    throw Error(ErrorKind::Usage, name + ": a sequence chooses the time of each frame itself: give the name alone");
  return *make_builtin_scene(fmt::format("{}:time={:.6f}", name, std::clamp(choice.time, 0.0, 10.0)));
}

}  // namespace

Scene load_scene(const std::string& name, const LoadOptions& options) {
  if (options.format.empty() && name != "-")
    if (std::optional<Scene> scene = make_builtin_scene(name)) {
      if (scene->animations.empty()) static_cast<void>(limits_of(options));
      return options.choice.animation && !scene->animations.empty() ? moment_of_builtin(name, options.choice)
                                                                    : std::move(*scene);
    }
  const Reader reader = reader_of(name, options);
  const bool has_child = options.is_sandboxed && !reader.is_assimp;
  return has_child ? read_in_child(name, reader, options) : read_watched(name, reader, options);
}

std::vector<std::string> readable_paths(const std::string& name, const LoadOptions& options) {
  if (options.format.empty() && is_builtin_scene(name)) return {};
  return model_paths(name, options.limits);
}

struct SceneSource::OpenFile {
  MappedFileWatch watch;
  std::unique_ptr<GltfModel> gltf;  ///< null: the file is read again for each scene
};

SceneSource::SceneSource(std::string name, LoadOptions options) : name_(std::move(name)), options_(std::move(options)) {
  auto file = std::make_unique<OpenFile>();
  const auto [extension, is_assimp] = reader_of(name_, options_);
  const bool is_gltf = extension == ".gltf" || extension == ".glb" || extension == ".vrm";
  if (is_gltf && !is_assimp && !options_.is_sandboxed && (name_ != "-" || !options_.format.empty()))
    file->gltf = std::make_unique<GltfModel>(name_, options_.limits);
  file->watch.check(name_);
  file_ = std::move(file);
}
SceneSource::~SceneSource() = default;

Scene SceneSource::load(const SceneChoice& choice) {
  options_.choice = choice;
  Scene scene = file_->gltf ? file_->gltf->scene(choice) : load_scene(name_, options_);
  file_->watch.check(name_);
  return scene;
}

Scene SceneSource::load_shape(const SceneChoice& choice) {
  if (!file_->gltf) return load(choice);
  Scene scene = file_->gltf->scene(choice, GltfModel::Images::Without);
  file_->watch.check(name_);
  return scene;
}

std::vector<double> SceneSource::key_times(const SceneChoice& choice) {
  return file_->gltf ? file_->gltf->key_times(choice) : std::vector<double>();
}

}  // namespace zoneplate
