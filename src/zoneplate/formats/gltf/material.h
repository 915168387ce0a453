// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/scene/material.h"

namespace zoneplate {

struct GltfMaterials {
  std::vector<Material> materials;   ///< the file's, in its order
  std::vector<TextureImage> images;  ///< those that a material uses
};

/// Reads all materials and decodes the images that they use, the images in parallel.
///
/// Factors out of their range are clamped and textures of a third uv set left out, both with a warning.
/// Errors    ErrorKind::Input naming the material or image: a bad index or value, an image that cannot be read.
GltfMaterials load_materials(GltfFile& file);

}  // namespace zoneplate
