// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The formats that the library assimp supports.
std::span<const SceneFormat> assimp_formats();

/// Loads a model with the library assimp, which is opened at its first use, in a child process.
///
/// The result has the nodes with their meshes, those properties of materials that MTL can express, and textures,
/// including embedded ones; no animations, bones, lights and cameras. Polygons are triangulated, and missing normals
/// are computed as for PLY.
///
/// Inside a LimitedChild, which has limits already, the library runs in that process.
/// Requires  `extension` is one of assimp_formats(), or ".gltf" for glTF 1.0, text or binary; `budget` names the file.
/// Errors    ErrorKind::Input with the library's own message if it rejects the file; also if it crashes or is not
///           installed.
Scene load_by_assimp(const std::string& path, std::string_view extension, ImportBudget& budget);

}  // namespace zoneplate
