#include "zoneplate/scene/load.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/scene/builtin.h"
#include "zoneplate/scene/gltf.h"
#include "zoneplate/scene/obj.h"

namespace zoneplate {
namespace {

constexpr SceneFormat formats[] = {{".gltf", "glTF 2.0, with its buffers and images"},
                                   {".glb", "glTF 2.0 in one binary file"},
                                   {".obj", "Wavefront OBJ, with its MTL materials"}};

using Loader = Scene (*)(const std::string&, const LoadLimits&);
constexpr Loader loaders[] = {load_gltf, load_gltf, load_obj};
static_assert(std::size(loaders) == std::size(formats));

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace

std::span<const SceneFormat> scene_formats() { return formats; }

bool is_builtin_scene(std::string_view name) {
  const std::string_view stem = name.substr(0, name.find(':'));
  const auto scenes = builtin_scenes();
  return std::any_of(scenes.begin(), scenes.end(), [&](const BuiltinScene& scene) { return scene.name == stem; });
}

Scene load_scene(const std::string& name, const LoadLimits& limits) {
  if (std::optional<Scene> scene = make_builtin_scene(name)) return std::move(*scene);

  const std::string extension = lower_case(std::filesystem::path(name).extension().string());
  for (std::size_t i = 0; i < std::size(formats); ++i)
    if (extension == formats[i].extension) return loaders[i](name, limits);

  std::error_code ignored;
  const bool exists = std::filesystem::exists(name, ignored);
  std::string wanted;
  for (const SceneFormat& format : formats) wanted.append(wanted.empty() ? "" : ", ").append(format.extension);
  throw Error(Trouble::Input, exists ? name + ": not a format that can be read (" + wanted + ")"
                                     : name + ": no such file, and no built-in scene of that name");
}

}  // namespace zoneplate
