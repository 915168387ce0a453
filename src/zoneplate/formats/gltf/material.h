// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/scene/material.h"

namespace zoneplate {

struct GltfMaterials {
  std::vector<Material> materials;   ///< the file's materials, in order
  std::vector<TextureImage> images;  ///< the images that materials use
};

/// Reads all materials and decodes the images that they use, the images in parallel.
///
/// Factors out of range are clamped and textures of a third uv set omitted, both with a warning.
/// Errors    ErrorKind::Input naming the material or image: an invalid index or value, an unreadable image.
GltfMaterials load_materials(GltfFile& file);

}  // namespace zoneplate
