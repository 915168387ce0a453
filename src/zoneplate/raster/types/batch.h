#pragma once

#include <cstddef>
#include <cstdint>

namespace zoneplate {

/// Surface points that are shaded together: one material, any triangles, structure of arrays.
///
/// A point is one (pixel, triangle) pair, or one (sample, triangle) pair at rate *sample*. Every loop over a batch
/// treats entries independently, so a point's colour never depends on its neighbours. Entries [count, padded()) repeat
/// the last point, so that loops may run in whole groups of 8.
///
/// Units     x, y: the point in 1/256 pixel from the picture's top-left corner; b: perspective-correct barycentric
///           weights of the second and the third vertex, the first has what is left of one; dbdx, dbdy: their change
///           per pixel (per sample spacing at rate *sample*), set where the shader needs them.
struct Batch {
  static constexpr int capacity = 256;
  static constexpr int group = 8;
  static constexpr int groups = capacity / group;

  /// Loops over a batch may go in vectors of as many points at most: what stands between padded() and its next multiple
  /// may be read and written, and means nothing.
  static constexpr int most_lanes = 16;

  /// The length of arrays by point: a cache line more, so that what stands at one place in many of them does not crowd
  /// into the same few lines of the first cache.
  static constexpr int room = capacity + most_lanes;

  int count = 0;
  int material = 0;           ///< index into Scene::materials
  bool one_instance = false;  ///< all points are known to be of instance[0]

  /// The group's points share their triangle and lie side by side in a row, a pixel apart: what is said by triangle
  /// then stands at the first point of the group `told_group` only, the first of those that follow each other and share
  /// the triangle; `run_end`, known there, is the group after them.
  bool one_triangle[groups] = {};
  std::uint8_t told_group[groups] = {};
  std::uint8_t run_end[groups] = {};

  /// dbdx and dbdy of all of the group's points are those of the point before it.
  bool repeats_slopes[groups] = {};

  // By triangle.
  alignas(64) std::uint32_t triangle[room];   ///< triangle id, in draw order over the whole frame
  alignas(64) std::uint32_t instance[room];   ///< index into Scene::instances
  alignas(64) std::uint32_t vertex[3][room];  ///< the mesh's vertices to which b belongs (lines: a, b, b)
  alignas(64) std::int32_t is_front[room];    ///< 1 if the front face is seen, else 0

  // By point.
  alignas(64) std::int32_t x[room], y[room];
  alignas(64) float b[2][room];
  alignas(64) float dbdx[2][room], dbdy[2][room];

  int padded() const { return (count + group - 1) / group * group; }
  /// Where point i's triangle is told of.
  std::size_t told(std::size_t i) const {
    return one_triangle[i / group] ? static_cast<std::size_t>(told_group[i / group]) * group : i;
  }
  /// The group after `first` and those that share its triangle; `first` shares none with the group before it.
  int after_run(int first) const { return one_triangle[first] ? run_end[first] : first + 1; }
};

/// What shading gives for a batch. Colour is linear and premultiplied. The rest is filled when asked for.
struct Shaded {
  alignas(64) float r[Batch::room], g[Batch::room], b[Batch::room], a[Batch::room];
  alignas(64) float normal[3][Batch::room];  ///< world space, unit length, towards the viewer's side
  alignas(64) float uv[2][Batch::room];      ///< the base colour's texture coordinate
  alignas(64) float albedo[3][Batch::room];  ///< linear base colour
};

}  // namespace zoneplate
