#pragma once

#include <span>
#include <string>
#include <string_view>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

struct SceneFormat {
  std::string_view extension;  ///< lower case, with its dot
  std::string_view summary;
};

/// The file formats that `load_scene` reads.
std::span<const SceneFormat> scene_formats();

/// True for the name of a built-in scene, with or without parameters.
bool is_builtin_scene(std::string_view name);

/// Loads a file by its extension, or makes the built-in scene of that name: "chair.glb", "sphere:triangles=1000".
///
/// A built-in scene goes before a file of the same name, which is reached as "./teapot".
/// Errors    Trouble::Input naming a file that is missing, of an unknown format or wrong inside; Trouble::Usage for
///           parameters of a built-in scene.
Scene load_scene(const std::string& name, const LoadLimits& limits = {});

}  // namespace zoneplate
