// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include "zoneplate/formats/obj/mtl_material.h"

namespace zoneplate {

/// What faces of three or more corners are.
enum class Polygons {
  Filled,
  Polylines,  ///< open
};

/// Converts assimp's scene, which is not trusted; textures are searched in `folder`. `extension` is that of the format,
/// as ".fbx", in lower case.
///
/// Errors    ErrorKind::Input: indices out of range, nodes nested too deeply, limits exceeded.
void convert_assimp_scene(const aiScene& from, std::string_view extension, Polygons polygons, ModelFolder& folder);

}  // namespace zoneplate
