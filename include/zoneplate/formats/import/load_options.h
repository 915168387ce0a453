// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#pragma GCC visibility push(default)
namespace zoneplate {

/// A file format that holds a scene.
struct SceneFormat {
  std::string_view extension{};  ///< lower case, with its dot
  std::string_view summary{};    ///< one line for listings
};

/// Selects a scene, a material variant and a time of a glTF file.
struct SceneChoice {
  static constexpr int all_animations = -1;  ///< of `animation`: all of them at once
  std::optional<int> scene{};                ///< index into the file's scenes; none: the file's default scene
  std::string variant{};                     ///< of KHR_materials_variants; empty: the default materials
  std::optional<int> animation{};            ///< index into the file's animations, or all of them; none: not animated
  double time = 0;                           ///< of the animation, in seconds; clamped to its time span
  std::string animation_name{};              ///< the first animation of this name, instead of an index; empty: none
};

/// Limits on the resources of a loader, and on what it accepts.
struct LoadLimits {
  std::uint64_t memory = std::uint64_t{4} << 30;  ///< bytes of decoded scene data (--max-memory)
  std::uint64_t pixels = std::uint64_t{1} << 28;  ///< of one image (--max-pixels)
  double seconds = 60;                            ///< for one import
  int node_depth = 256;                           ///< levels of a file's node hierarchy
  bool is_strict = false;  ///< an image that cannot be read is an error (--strict), not a warning
  /// Files, and folders with all below them, that a model may use in addition to its own folder (--allow-path).
  std::vector<std::string> allowed_paths = {};
};

}  // namespace zoneplate
#pragma GCC visibility pop
