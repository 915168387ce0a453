// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include "zoneplate/formats/obj/mtl_material.h"

namespace zoneplate {

/// Converts assimp's scene, which is not trusted; textures are searched in `folder`. `extension` is that of the format,
/// as ".fbx", in lower case.
///
/// Errors    ErrorKind::Input: indices out of range, nodes nested too deeply, limits exceeded.
void convert_assimp_scene(const aiScene& from, std::string_view extension, ModelFolder& folder);

}  // namespace zoneplate
