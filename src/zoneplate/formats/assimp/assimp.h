#pragma once

#include <span>
#include <string>
#include <string_view>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The formats that are left to the library assimp.
std::span<const SceneFormat> assimp_formats();

/// Loads a model by the library assimp, which is opened when it is wanted, in a child process that may be lost.
///
/// Taken over are the nodes with their meshes, materials as far as MTL has their like, and textures, those in the file
/// too; not animations, poses of bones, lights and cameras. Polygons are cut and missing normals made as for PLY.
///
/// In a LimitedChild, which has its limits already, the library works in that process.
/// Requires  `extension` is one of assimp_formats().
/// Errors    ErrorKind::Input with the library's own words where it refuses the file, where it crashes, and where it is
///           not installed.
Scene load_by_assimp(const std::string& path, std::string_view extension, const LoadLimits& limits);

}  // namespace zoneplate
