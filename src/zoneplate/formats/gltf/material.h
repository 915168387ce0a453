// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/scene/material.h"

namespace zoneplate {

struct GltfMaterials {
  std::vector<Material> materials;       ///< the file's, in its order
  std::vector<std::size_t> used_images;  ///< those of the file's images that a material uses
  std::vector<int> image_numbers;        ///< for each of these, its index in `images`; -1: it could not be decoded
  std::vector<TextureImage> images;      ///< the decoded ones
};

/// Reads all materials again, after an animation has changed their properties, with the images that are decoded.
///
/// Errors    as load_materials, but for the images.
std::vector<Material> read_materials(GltfFile& file, const GltfMaterials& decoded);

/// Reads all materials and decodes the images that they use, the images in parallel.
///
/// Factors out of range are clamped and textures of a third uv set omitted, both with a warning.
/// Errors    ErrorKind::Input naming the material or image: an invalid index or value, an unreadable image.
GltfMaterials load_materials(GltfFile& file);

}  // namespace zoneplate
