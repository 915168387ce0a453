// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "zoneplate/raster/geometry/arena.h"
#include "zoneplate/scene/scene.h"
#include "zoneplate/shade/surface/shading_state.h"

namespace zoneplate {

/// The attributes that a material needs.
struct Attributes {
  bool position = false, normal = false, tangent = false, uv[2] = {false, false}, color = false;
  bool normal_change = false;    ///< the derivatives of the normal; with `normal`
  bool object_position = false;  ///< with its derivatives
  int tangent_uv_set = 0;        ///< the coordinates from which tangents are made where a mesh has none
};

/// The offsets of the attributes in a vertex record. Records hold only attributes that some mesh of the material has.
///
/// Shape     floats: normal x y z, position x | position y z, u v | tangent x y z w | colour r g b a | second u v, 0,
/// 0.
struct RecordLayout {
  int floats = 8;                          ///< from one vertex to the next; a multiple of four
  int tangent = -1, color = -1, uv1 = -1;  ///< first float; -1: absent
};

/// The attributes of a scene's vertices, interleaved: all that shading reads of one vertex is contiguous.
///
/// An attribute that a mesh lacks and another mesh of its material has is 0, a missing colour (1, 1, 1, 1). A record of
/// eight floats lies within one cache line, and large meshes in large pages, because the access is random.
class InterleavedVertices {
 public:
  /// The records are made in parallel. Those of a material that needs no tangents (see
  /// needs_tangents) have none.
  explicit InterleavedVertices(const Scene& scene);

  const RecordLayout& layout(int material) const { return layouts_[static_cast<std::size_t>(material)]; }
  const float* of_instance(std::size_t instance) const { return instances_[instance]; }

 private:
  std::vector<RecordLayout> layouts_;  ///< by material
  std::vector<RawMemory> meshes_;
  std::vector<const float*> instances_;
};

/// Finds the vertex records of a batch's triangles.
void fetch_vertex_records(const InterleavedVertices& records, const FragmentBatch& batch, TriangleVertices& out);

/// The interpolation of the attributes from records of this layout.
Interpolation interpolation(const RecordLayout& layout, const Attributes& attributes);

/// Sets the tangents of fragments of meshes without tangents: the direction in which u grows over the triangle (zero
/// where the triangle has no area in u, v); w: the sign of that area.
void make_missing_tangents(const Scene& scene, const FragmentBatch& batch, int uv_set, ShadingState& state);

/// Of each fragment's triangle, in world space: the gradients of its texture coordinates along the surface, which are
/// the changes of u and of v per world unit, and its unit normal, on the side that is seen. Zero where the triangle has
/// no area.
struct SurfaceGradients {
  float u[3][FragmentBatch::padded_capacity], v[3][FragmentBatch::padded_capacity];
  float normal[3][FragmentBatch::padded_capacity];
};
void compute_surface_gradients(const Scene& scene, const FragmentBatch& batch, int uv_set, SurfaceGradients& out);

/// Sets `is_lit` to 1 for the fragments of meshes that have normals, else to 0.
void mark_lit(const Scene& scene, const FragmentBatch& batch, float* is_lit);

std::vector<InstanceTransform> make_instance_transforms(std::span<const Instance> instances);

}  // namespace zoneplate
