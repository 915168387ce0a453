// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include "zoneplate/formats/obj/mtl_material.h"

namespace zoneplate {

/// Fills a scene with what assimp has read; `folder` is where its textures are looked for. Nothing of it is trusted.
///
/// Errors    ErrorKind::Input: indices out of range, nodes too deep, the limits.
void convert_assimp_scene(const aiScene& from, ModelFolder& folder);

}  // namespace zoneplate
