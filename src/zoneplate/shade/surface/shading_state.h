// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/raster/types/batch.h"
#include "zoneplate/shade/environment/environment_view.h"

namespace zoneplate {

/// The values of a batch's fragments between the stages of shading: a structure of arrays that all stages share.
///
/// Each stage reads some arrays and writes others; arrays that a material does not need stay unset. Directions have
/// unit length, or are zero where a fragment has none.
struct ShadingState {
  static constexpr int capacity = FragmentBatch::capacity;
  using Array = float[FragmentBatch::padded_capacity];

  int count = 0;  ///< a multiple of FragmentBatch::group

  /// The part of each light that reaches each fragment, in [0, 1]: one array of padded_capacity for each light, one
  /// after the other; null: no light is shadowed.
  const float* light_visibility = nullptr;

  /// The environment's levels of the roughness that all fragments have, and of their clear coat's.
  MixedLevel mixed, coat_mixed;

  // Interpolated from the vertices; in world space after the transform stages.
  alignas(64) Array position[3], normal[3], tangent[4], color[4];
  alignas(64) Array uv[2][2], uv_dx[2][2],
      uv_dy[2][2];  ///< by set; derivatives are unset where the batch repeats them
  /// Of the interpolated normal, unset likewise; after compute_normal_variance the vectors of a TurningLobe.
  alignas(64) Array normal_dx[3], normal_dy[3];
  alignas(64) Array is_lit;  ///< 1, or 0 for fragments of meshes without normals

  // The material at the fragments.
  alignas(64) Array base[4];
  alignas(64) Array metallic, roughness, occlusion;
  alignas(64) Array normal_variance;  ///< for specular antialiasing: is added to the square of GGX's α
  alignas(64) Array emissive[3];
  alignas(64) Array specular[3], exponent;  ///< of (Blinn-)Phong, where they are textured

  // Of materials with a solid texture: the position in object space, and its derivatives per pixel, which are unset
  // where the batch repeats them.
  alignas(64) Array object_position[3], object_dx[3], object_dy[3];
};

/// The vertex records (shade/surface/vertices.h) of a batch's triangles. A group of one triangle has them at the leader
/// of its run (FragmentBatch) only.
struct TriangleVertices {
  /// Not null: the record of any vertex of the batch is first + stride × vertex, and `record` is unset for groups of
  /// several triangles.
  const float* first = nullptr;
  std::size_t stride = 0;
  const float* record[3][FragmentBatch::padded_capacity];
  bool one_instance[FragmentBatch::groups];
};

/// The vertex records of groups of several triangles, where all records of the batch lie in one array.
struct RecordsByVertex {
  const FragmentBatch& batch;
  const float* first;
  std::size_t stride;
  const float* operator()(int k, int i) const { return first + stride * batch.vertex[k][i]; }
};
/// The same where the batch has several instances.
struct RecordsByFragment {
  const TriangleVertices& vertices;
  const float* operator()(int k, int i) const { return vertices.record[k][i]; }
};

/// The transform of an instance in the form that kernels read.
struct InstanceTransform {
  float world_from_object[12];  ///< columns x, y, z and origin, three numbers each
  float normal[9];              ///< columns of the normal matrix, to any scale
  float handedness;             ///< -1 where the transform mirrors
  float keeps_normals;          ///< 1 where the normal matrix is the identity, else 0
  float scale;                  ///< of lengths, on average over the axes
  /// A length of the object along the unit vector d of the world is this / |normalᵀ d| times as long in the world; 0:
  /// as much as `scale` says, in every direction.
  float scale_along;
};

/// One array of a ShadingState, by its offset, so that it applies to any of them; none by default.
struct StateArray {
  std::int32_t offset = 0;  ///< from the beginning of ShadingState, in bytes
  bool is_none() const { return offset == 0; }
  float* of(ShadingState& p) const { return reinterpret_cast<float*>(reinterpret_cast<unsigned char*>(&p) + offset); }
};

/// Into which arrays the floats of the vertex records are interpolated, four floats at a time. An array is none where
/// the value, or its derivative, is not needed.
struct Interpolation {
  struct Quad {
    int offset = 0;  ///< of the first float in the record
    /// The first three floats are normals that only compute_normals reads: those of a run, if they are equal at all
    /// vertices, are stored for its first group only.
    bool has_sparse_normals = false;
    StateArray value[4], dx[4], dy[4];
  };
  int quads = 0;
  Quad quad[5];
};

}  // namespace zoneplate
