// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {

/// Reads the texture under a key of a JSON object.
using TextureReader = std::function<TextureUse(const JsonView& owner, const std::string& key)>;

/// The layers of a material that glTF's material extensions describe; null where it has none of them.
///
/// Factors out of their range are clamped with a warning. Of KHR_materials_pbrSpecularGlossiness only the specular and
/// glossiness parameters are read here.
/// Errors    ErrorKind::Input: a value of the wrong kind, those of `texture`.
std::shared_ptr<const MaterialLayers> read_layers(GltfFile& file, const JsonView& material,
                                                  const TextureReader& texture);

}  // namespace zoneplate
