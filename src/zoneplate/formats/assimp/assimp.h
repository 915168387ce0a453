// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The formats that the library assimp reads.
std::span<const SceneFormat> assimp_formats();

/// Loads a model by the library assimp, which is loaded at its first use, in a child process.
///
/// The result has the nodes with their meshes, materials as far as MTL can express them, and textures, including
/// embedded ones; no animations, bones, lights and cameras. Polygons are triangulated and missing normals computed as
/// for PLY.
///
/// Inside a LimitedChild, which has limits already, the library runs in that process.
/// Requires  `extension` is one of assimp_formats().
/// Errors    ErrorKind::Input with the library's own message if it rejects the file; also if it crashes or is not
///           installed.
Scene load_by_assimp(const std::string& path, std::string_view extension, const LoadLimits& limits);

}  // namespace zoneplate
