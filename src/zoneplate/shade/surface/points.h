#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// Everything known of a batch's points while they are shaded: the stages' common work space, structure of arrays.
///
/// Each stage reads some arrays and writes others; those that a material does not need stay unset. Directions are of
/// unit length, or zero where there is none.
struct ShadingState {
  static constexpr int capacity = FragmentBatch::capacity;
  using Array = float[FragmentBatch::padded_capacity];

  int count = 0;  ///< a multiple of FragmentBatch::group

  /// The part of each light that reaches each fragment, in [0, 1]: one array of padded_capacity for each light, one
  /// after the other; null: no light is shadowed.
  const float* light_visibility = nullptr;

  // Interpolated from the vertices; world space once placed.
  alignas(64) Array position[3], normal[3], tangent[4], color[4];
  alignas(64) Array uv[2][2], uv_dx[2][2],
      uv_dy[2][2];           ///< by set; changes not where the batch repeats its derivatives
  alignas(64) Array is_lit;  ///< 1, or 0 for points of meshes without normals

  // The material at the points.
  alignas(64) Array base[4];
  alignas(64) Array metallic, roughness, occlusion;
  alignas(64) Array emissive[3];
};

/// The records of the triangles' corners (shade/surface/vertices.h); where a group shares its triangle, where it is
/// told (FragmentBatch) only.
struct TriangleVertices {
  /// Not null: the record of any of the batch's vertices is first + stride × vertex, and `record` says nothing of
  /// groups of several triangles.
  const float* first = nullptr;
  std::size_t stride = 0;
  const float* record[3][FragmentBatch::padded_capacity];
  bool one_instance[FragmentBatch::groups];
};

/// Finds the records of a batch's corners, of groups of several triangles: those that stand in one array by their
/// vertices.
struct RecordsByVertex {
  const FragmentBatch& batch;
  const float* first;
  std::size_t stride;
  const float* operator()(int corner, int i) const { return first + stride * batch.vertex[corner][i]; }
};
/// The same of others.
struct RecordsByPoint {
  const TriangleVertices& corners;
  const float* operator()(int corner, int i) const { return corners.record[corner][i]; }
};

/// One placement of a mesh as kernels see it.
struct InstanceTransform {
  float world_from_object[12];  ///< columns x, y, z and origin, three numbers each
  float normal[9];              ///< columns of the normal matrix, to any scale
  float handedness;             ///< -1 where the placement mirrors
  float keeps_normals;          ///< 1 where normals need no turning, else 0
  float unused;
};

/// An array of ShadingState, which it may not belong to yet; none by itself.
struct PointsArray {
  std::int32_t offset = 0;  ///< from the beginning of ShadingState, in bytes
  bool is_none() const { return offset == 0; }
  float* of(ShadingState& p) const { return reinterpret_cast<float*>(reinterpret_cast<unsigned char*>(&p) + offset); }
};

/// Where the floats of the records go, four at a time; none where a value or its derivatives are not wanted.
struct Interpolation {
  struct Quad {
    int place = 0;  ///< first float in the record
    PointsArray value[4], dx[4], dy[4];
  };
  int quads = 0;
  Quad quad[5];
};

}  // namespace zoneplate
