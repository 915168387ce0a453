// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The look of surfaces for which the model's file defines no material: STL, PLY, and the default material of others.
struct DefaultMaterial {
  std::optional<float4> color;               ///< linear, straight alpha; multiplies colours of vertices
  std::optional<float> metallic, roughness;  ///< one of them makes the material metallic-roughness
  std::string texture;                       ///< file of the base colour; empty: none
  std::string normal_map, height_map;        ///< files; empty: none
  std::optional<float> height_scale;         ///< of white above black; none: a hundredth of the longest side

  /// The image files.
  std::vector<std::string> files() const {
    std::vector<std::string> out;
    for (const std::string* file : {&texture, &normal_map, &height_map})
      if (!file->empty()) out.push_back(*file);
    return out;
  }
  bool is_set() const { return color || metallic || roughness || !files().empty(); }
};

/// Gives the default materials of the scene this look, and adds a warning where it has no effect.
///
/// Errors    those of reading the texture.
void set_default_material(const DefaultMaterial& look, const LoadLimits& limits, Scene& scene);

}  // namespace zoneplate
