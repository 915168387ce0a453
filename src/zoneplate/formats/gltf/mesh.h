// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/math/mat.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// The pose in which a mesh is read, from its node and skin.
struct GltfPose {
  std::vector<float> weights;          ///< weights of the morph targets; empty: the mesh's own
  std::vector<float4x4> joints;        ///< world from mesh, for each joint; empty: not skinned
  std::optional<std::size_t> variant;  ///< index of a variant of KHR_materials_variants
};

/// A primitive of a mesh of the file, by its number.
struct GltfPrimitive {
  int number = 0;
  Mesh mesh;
};

/// Reads one mesh of the file: each primitive that is not empty.
///
/// Strips, fans and loops become lists; morph targets and joints are applied; missing normals and tangents are
/// generated. The material index of a primitive without a material is the size of `materials`.
/// Errors    ErrorKind::Input naming mesh, primitive and attribute.
std::vector<GltfPrimitive> load_gltf_mesh(GltfFile& file, std::size_t number, const GltfPose& pose,
                                          std::span<const Material> materials);

}  // namespace zoneplate
