// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "zoneplate/scene/scene.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// A row of the list of scenes that are made in code.
struct BuiltinScene {
  std::string name{};       ///< as given on the command line, before any ':'
  std::string summary{};    ///< one line for `zoneplate list`
  std::string params{};     ///< its parameters with defaults, "triangles=10000", or empty
  std::string failure{};    ///< the class of artifacts that it shows ("sub-pixel"), or empty
  std::string complaint{};  ///< a description of the artifact, and the source of a user's report
};

/// The scenes that are made in code, in the order in which they are listed.
std::span<const BuiltinScene> builtin_scenes();

/// The row of a text such as `teapot` or `sphere:triangles=1000`; null if no built-in scene has that name.
const BuiltinScene* find_builtin_scene(std::string_view text);

/// Whether a text such as `sphere:triangles=1000` names a built-in scene, without making it.
///
/// Errors    as make_builtin_scene.
bool check_builtin_scene(const std::string& text);

/// Makes the scene of a text such as `teapot` or `sphere:triangles=1000`; nothing if no built-in scene has that name.
///
/// Errors    ErrorKind::Usage naming an unknown parameter or a value out of range.
std::optional<Scene> make_builtin_scene(const std::string& text);

}  // namespace zoneplate
#pragma GCC visibility pop
