// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/base/lower_case.h"
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

/// Throws if the options choose a scene, variant or animation, which only glTF files have.
void refuse_choice(const SceneChoice& c) {
  if (c.scene || c.animation || !c.animation_name.empty() || !c.variant.empty())
    throw Error(ErrorKind::Usage, "only glTF files have scenes, variants and animations to choose from");
}
const LoadLimits& limits_of(const LoadOptions& o) {
  refuse_choice(o.choice);
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

/// The reader of the formats with this extension; null if there is none.
Loader loader_of(const std::string& extension) {
  const SceneFormat* const found = std::ranges::find(formats, extension, &SceneFormat::extension);
  return found == std::end(formats) ? nullptr : loaders[found - std::begin(formats)];
}

/// The extension by which a format is chosen, or that of the name.
std::string extension_of(const std::string& name, const std::string& format) {
  if (format.empty()) return lower_case(std::filesystem::path(name).extension().string());
  return lower_case((format.starts_with('.') ? "" : ".") + format);
}

bool is_assimp_format(const std::string& extension) {
  return std::ranges::find(assimp_formats(), extension, &SceneFormat::extension) != assimp_formats().end();
}

/// Whether the file can be opened a second time and then has the same bytes.
bool is_repeatable(const std::string& name) {
  std::error_code ignored;
  return name != "-" && std::filesystem::is_regular_file(name, ignored);
}

/// The same extension; where that of the name is not known, binary glTF and ZIP archives, which are taken as 3MF, are
/// known by their first bytes.
///
/// Errors    those of read_parts.
std::string extension_by_contents(const std::string& name, const std::string& format) {
  std::string extension = extension_of(name, format);
  const bool is_known = loader_of(extension) != nullptr || is_assimp_format(extension);
  if (is_known || !format.empty() || !is_repeatable(name)) return extension;
  read_parts(name, [&](std::span<const std::uint8_t> begin) {
    extension = is_binary_gltf(begin) ? ".glb" : is_zip(begin) ? ".3mf" : extension;
    return false;
  });
  return extension;
}

/// The result of `read`, which reads a glTF file; nothing if the file is glTF 1.0, which assimp can read.
template <class Read>
auto unless_gltf_1(const std::string& name, const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Gltf1Error&) {
    if (!is_repeatable(name)) throw;
    return std::nullopt;
  }
}

}  // namespace

std::span<const SceneFormat> scene_formats() { return formats; }

bool is_builtin_scene(std::string_view name) {
  const std::string_view stem = name.substr(0, name.find(':'));
  const auto scenes = builtin_scenes();
  return std::any_of(scenes.begin(), scenes.end(), [&](const BuiltinScene& scene) { return scene.name == stem; });
}

namespace {

bool is_builtin(const std::string& name, const LoadOptions& options) {
  return options.format.empty() && is_builtin_scene(name);
}

/// Reads a file by the reader of its format, or throws an error with the cause. Nothing if it is glTF 1.0.
std::optional<Scene> read_file(const std::string& name, const LoadOptions& options) {
  std::string readable;
  for (const SceneFormat& format : formats) readable.append(readable.empty() ? "" : ", ").append(format.extension);
  if (name == "-" && options.format.empty())
    throw Error(ErrorKind::Usage, "standard input requires --format (" + readable + ")");
  const std::string extension = extension_by_contents(name, options.format);
  if (const Loader loader = loader_of(extension)) return unless_gltf_1(name, [&] { return loader(name, options); });

  readable += " and others, see zoneplate list formats";
  if (!options.format.empty())
    throw Error(ErrorKind::Usage, "'" + options.format + "' is not a format that can be read (" + readable + ")");
  std::error_code ignored;
  const bool exists = std::filesystem::exists(name, ignored);
  constexpr std::string_view images[] = {".png",  ".jpg",  ".jpeg", ".webp", ".gif", ".tif",
                                         ".tiff", ".avif", ".jxl",  ".bmp",  ".tga"};
  if (exists && std::ranges::find(images, extension) != std::end(images))
    throw Error(ErrorKind::Input, name + ": is an image, expected a model; zoneplate filter antialiases images");
  throw Error(ErrorKind::Input, exists ? name + ": not a format that can be read (" + readable + ")"
                                       : name + ": no such file, and no built-in scene of that name");
}

/// The result of `read`, unless a mapped file has lost bytes meanwhile.
template <class Read>
auto watched(const std::string& name, const Read& read) {
  const MappedFileWatch watch;
  auto result = read();
  watch.check(name);
  return result;
}

/// Calls read_file in a child process with limits of its resources.
std::optional<Scene> read_in_child(const std::string& name, const LoadOptions& options, ImportBudget& budget) {
  LimitedChild child(
      budget.file(), child_limits(budget),
      [&](ChildAnswer& answer) {
        const std::optional<Scene> scene = watched(name, [&] { return read_file(name, options); });
        const std::uint8_t has_scene = scene ? 1 : 0;
        answer.write(&has_scene, 1);
        if (scene) write_scene(*scene, [&](const void* data, std::size_t size) { answer.write(data, size); });
      },
      [] {
        open_library(Library::OpenExr);
        open_library(Library::Meshoptimizer);
        open_library(Library::Zstd);
      });
  std::uint8_t has_scene = 0;
  child.read(&has_scene, 1);
  if (has_scene == 0) return std::nullopt;
  return read_scene([&](void* out, std::size_t size) { child.read(out, size); }, budget);
}

/// Reads a file in this process or in a child. Nothing if assimp has to read it.
std::optional<Scene> read_without_assimp(const std::string& name, const LoadOptions& options, ImportBudget& budget) {
  if (is_assimp_format(extension_of(name, options.format))) return std::nullopt;
  return options.is_sandboxed ? read_in_child(name, options, budget)
                              : watched(name, [&] { return read_file(name, options); });
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
  ImportBudget budget(name == "-" ? "standard input" : name, options.limits);
  if (std::optional<Scene> scene = read_without_assimp(name, options, budget)) return std::move(*scene);
  refuse_choice(options.choice);
  const std::string extension = extension_of(name, options.format);
  return watched(name, [&] { return load_by_assimp(name, is_assimp_format(extension) ? extension : ".gltf", budget); });
}

std::vector<std::string> readable_paths(const std::string& name, const LoadOptions& options) {
  if (is_builtin(name, options)) return {};
  return model_paths(name, options.limits);
}

struct SceneSource::OpenFile {
  MappedFileWatch watch;
  std::unique_ptr<GltfModel> gltf;  ///< null: the file is read again for each scene
};

SceneSource::SceneSource(std::string name, LoadOptions options) : name_(std::move(name)), options_(std::move(options)) {
  auto file = std::make_unique<OpenFile>();
  // A sandboxed file is read in the process of each load alone.
  const bool can_stay_open = !options_.is_sandboxed && !is_builtin(name_, options_);
  if (can_stay_open && loader_of(extension_by_contents(name_, options_.format)) == read_gltf)
    file->gltf =
        unless_gltf_1(name_, [&] { return std::make_unique<GltfModel>(name_, options_.limits); }).value_or(nullptr);
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
