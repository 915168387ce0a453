#pragma once

#include <span>
#include <vector>

#include "zoneplate/raster/geometry/arena.h"
#include "zoneplate/scene/scene.h"
#include "zoneplate/shade/surface/points.h"

namespace zoneplate {

/// The attributes that a material needs.
struct Attributes {
  bool position = false, normal = false, tangent = false, uv[2] = {false, false}, color = false;
  int tangent_uv_set = 0;  ///< which coordinates a tangent is made from where a mesh has none
};

/// Where the attributes stand in a vertex's record. What no mesh of a material has, its records have no room for.
///
/// Shape     floats: normal x y z, position x | position y z, u v | tangent x y z w | colour r g b a | second u v, 0,
/// 0.
struct RecordLayout {
  int floats = 8;                          ///< from one vertex to the next; a multiple of four
  int tangent = -1, color = -1, uv1 = -1;  ///< first float; -1: absent
};

/// The attributes of a scene's vertices, one vertex after the other: what shading reads of a vertex lies together.
///
/// What a mesh lacks and others of its material have is 0, its colour (1, 1, 1, 1). A record of eight floats lies
/// within one cache line, and large meshes in large pages: shading reads vertices from anywhere.
class InterleavedVertices {
 public:
  /// Made in parallel. A material without a normal map has no tangents.
  explicit InterleavedVertices(const Scene& scene);

  const RecordLayout& layout(int material) const { return layouts_[static_cast<std::size_t>(material)]; }
  const float* of_instance(std::size_t instance) const { return instances_[instance]; }

 private:
  std::vector<RecordLayout> layouts_;  ///< by material
  std::vector<RawMemory> meshes_;
  std::vector<const float*> instances_;
};

/// Finds the records of a batch's corners.
void find_corners(const InterleavedVertices& records, const FragmentBatch& batch, TriangleVertices& out);

/// Which float of the records goes where in the points.
Interpolation interpolation(const RecordLayout& layout, const Attributes& attributes);

/// Gives the points of meshes without tangents the direction of growing u over their triangle (zero where the triangle
/// has no area in u, v; w: the sign of that area).
void make_missing_tangents(const Scene& scene, const FragmentBatch& batch, int uv_set, ShadingState& points);

/// 1 for the points of meshes that have normals, else 0.
void mark_lit(const Scene& scene, const FragmentBatch& batch, float* is_lit);

std::vector<InstanceTransform> make_placements(std::span<const Instance> instances);

}  // namespace zoneplate
