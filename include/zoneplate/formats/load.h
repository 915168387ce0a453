// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The file formats that `load_scene` reads itself. It reads others by the library assimp where that is installed.
std::span<const SceneFormat> scene_formats();

/// True for the name of a built-in scene, with or without parameters.
bool is_builtin_scene(std::string_view name);

/// Options of loading a scene.
struct LoadOptions {
  LoadLimits limits{};        ///< of memory, time and files
  std::string format{};       ///< an extension without its dot, "stl"; empty: that of the name
  SceneChoice choice{};       ///< scene, variant and moment of a glTF file
  bool is_sandboxed = false;  ///< reads in a child process with limits, whatever the format
};

/// Loads a file by its extension, or makes the built-in scene of that name: "chair.glb", "sphere:triangles=1000".
/// A ZIP archive of another extension is taken as 3MF.
///
/// A built-in scene takes precedence over a file of the same name, which is given as "./teapot". "-" is standard input,
/// and requires a format; files that it refers to are searched in the working directory. No default lights are
/// added: see light_unlit.
/// Errors    ErrorKind::Input naming a file that is missing, of an unknown format or wrong inside; ErrorKind::Usage for
///           parameters of a built-in scene, a format that is not read, and standard input without one.
Scene load_scene(const std::string& name, const LoadOptions& options = {});

/// The files and folders that loading this scene may read: the model, its folder (the working directory where the model
/// is standard input) and LoadLimits::allowed_paths; none for a built-in scene.
std::vector<std::string> readable_paths(const std::string& name, const LoadOptions& options);

/// A model that stays open, to be loaded at several moments of its animation.
///
/// Errors    as load_scene, in the constructor or later.
class SceneSource {
 public:
  /// Opens the file, by a name as for load_scene. `options.choice` is replaced by that of each call.
  SceneSource(std::string name, LoadOptions options);
  ~SceneSource();

  /// The scene at the chosen moment, with its images.
  Scene load(const SceneChoice& choice);
  /// The same without images.
  Scene load_shape(const SceneChoice& choice);
  /// Times, in seconds, at which the chosen animations may move something the farthest, the most important first: see
  /// SceneLoader::key_times. None where the source does not know them.
  std::vector<double> key_times(const SceneChoice& choice);

 private:
  struct OpenFile;
  std::string name_;
  LoadOptions options_;
  std::unique_ptr<OpenFile> file_;
};

}  // namespace zoneplate
#pragma GCC visibility pop
