#pragma once

#include <cstdint>

#include "zoneplate/raster/batch.h"

namespace zoneplate {

/// Everything known of a batch's points while they are shaded: the stages' common work space, structure of arrays.
///
/// Each stage reads some arrays and writes others; those that a material does not need stay unset. Directions are of
/// unit length, or zero where there is none.
struct Points {
  static constexpr int capacity = Batch::capacity;
  using Array = float[capacity];

  int count = 0;  ///< a multiple of Batch::group

  // Interpolated from the vertices; world space once placed.
  alignas(64) Array position[3], normal[3], tangent[4], color[4];
  alignas(64) Array uv[2][2], uv_dx[2][2], uv_dy[2][2];  ///< by set
  alignas(64) Array to_viewer[3];
  alignas(64) Array is_lit;  ///< 1, or 0 for points of meshes without normals

  // The material at the points.
  alignas(64) Array base[4];
  alignas(64) Array metallic, roughness, occlusion;
  alignas(64) Array emissive[3];

  // The light at hand, and what has been gathered so far.
  alignas(64) Array to_light[3], strength;
  alignas(64) Array diffuse[3], specular[3];
  alignas(64) Array sum[3];
};

/// The attributes of the triangles' corners, 8 points a block.
///
/// Shape     block g has channels × 3 × 8 floats, [channel][corner][point]; where `one_triangle[g]` is set, the 8
///           points share their corners and it has channels × 3, [channel][corner].
struct Corners {
  static constexpr int max_channels = 18;
  static constexpr int groups = Batch::capacity / Batch::group;
  std::uint8_t one_triangle[groups];
  std::uint8_t one_instance[groups];
  alignas(64) float block[groups][max_channels * 3 * Batch::group];
};

/// One placement of a mesh as kernels see it.
struct Placement {
  float world_from_object[12];  ///< columns x, y, z and origin, three numbers each
  float normal[9];              ///< columns of the normal matrix, to any scale
  float handedness;             ///< -1 where the placement mirrors
  float unused[2];
};

/// Where the interpolated channels go; dx and dy are null where derivatives are not wanted.
struct Interpolation {
  int channels = 0;
  float* value[Corners::max_channels] = {};
  float* dx[Corners::max_channels] = {};
  float* dy[Corners::max_channels] = {};
};

}  // namespace zoneplate
