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

/// Reads some triangles of a primitive whose mode is 4 as load_gltf_mesh does, in this order; each corner has its own
/// vertex. A primitive that is left out is empty.
///
/// Requires  the pose has neither weights nor joints; at least one triangle; all exist.
/// Errors    those of load_gltf_mesh; ErrorKind::Input for a vertex that does not exist.
Mesh load_gltf_triangles(GltfFile& file, const JsonView& primitive, const GltfPose& pose,
                         std::span<const Material> materials, std::span<const std::uint32_t> triangles);

/// The direction of a normal of the file; zero if its square is too small or too large for the precision of a float.
float3 gltf_direction(float3 v);

}  // namespace zoneplate
