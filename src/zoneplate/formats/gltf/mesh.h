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

/// The pose in which a mesh is read: what its node and skin add to the file's vertices.
struct GltfPose {
  std::vector<float> weights;          ///< of the morph targets; empty: the mesh's own
  std::vector<float4x4> joints;        ///< world from mesh, for each joint; empty: not skinned
  std::optional<std::size_t> variant;  ///< of KHR_materials_variants
};

/// Reads one mesh of the file as it is drawn: a Mesh for each primitive that draws something.
///
/// Strips, fans and loops become lists; morph targets and joints are applied; missing normals and tangents are made.
/// A primitive without a material gets the number after the last of `materials`.
/// Errors    ErrorKind::Input naming mesh, primitive and attribute.
std::vector<Mesh> load_gltf_mesh(GltfFile& file, std::size_t number, const GltfPose& pose,
                                 std::span<const Material> materials);

}  // namespace zoneplate
