// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#pragma GCC visibility push(default)
namespace zoneplate {

/// Fragments that are shaded together: they have one material and any triangles. Structure of arrays.
///
/// A fragment is one (pixel, triangle) pair, or one (sample, triangle) pair at rate *sample*. Every loop over a batch
/// treats entries independently, so a fragment's colour never depends on its neighbours. Entries [count, padded())
/// repeat the last fragment, so that loops may process whole groups of 8.
///
/// Units     x, y: the shading position in 1/256 pixel from the image's top-left corner; b: perspective-correct
///           barycentric weights of the second and the third vertex (the first weight is 1 minus both); dbdx, dbdy:
///           their screen-space derivatives per pixel (per sample spacing at rate *sample*), set where the shader needs
///           them.
struct FragmentBatch {
  static constexpr int capacity = 256;             ///< the most fragments of a batch
  static constexpr int group = 8;                  ///< fragments in a group
  static constexpr int groups = capacity / group;  ///< groups of a full batch

  /// The most lanes that a vector loop over a batch may have. Such a loop may read and write the entries between
  /// padded() and the next multiple of its lanes; their values are undefined.
  static constexpr int max_lanes = 16;

  /// The length of the arrays by fragment. The extra cache line keeps entries of the same index in different arrays
  /// from mapping to the same few sets of the first-level cache.
  static constexpr int padded_capacity = capacity + max_lanes;

  int count = 0;              ///< fragments in the batch
  int material = 0;           ///< index into Scene::materials
  bool one_instance = false;  ///< every fragment is known to belong to instance[0]

  // Flat runs. A group whose eight fragments share their triangle and lie side by side in a row, one pixel apart, has
  // is_flat_run set. Consecutive flat groups of one triangle form a run:
  //
  //   group         0    1    2    3    4    5
  //   triangle      A    A    A   mix   B    B
  //   is_flat_run   1    1    1    0    1    1
  //   run_begin     0    0    0    -    4    4
  //   run_end       3    -    -    -    6    -
  //
  // The arrays by triangle hold their values at the first fragment of group run_begin only. run_end, the group after
  // the run, is set there too.
  bool is_flat_run[groups] = {};        ///< by group: eight neighbours in a row, of one triangle
  std::uint8_t run_begin[groups] = {};  ///< by flat group: the first group of its run
  std::uint8_t run_end[groups] = {};    ///< by the first group of a run: the group after the run

  /// In these groups each fragment has the same dbdx and dbdy as the fragment before it.
  bool has_uniform_derivatives[groups] = {};

  // By triangle.
  alignas(64) std::uint32_t triangle[padded_capacity];   ///< triangle id, in draw order over the whole frame
  alignas(64) std::uint32_t instance[padded_capacity];   ///< index into Scene::instances
  alignas(64) std::uint32_t vertex[3][padded_capacity];  ///< the mesh's vertices to which b belongs (lines: a, b, b)
  alignas(64) std::int32_t is_front[padded_capacity];    ///< 1 if the front face is seen, else 0

  // By fragment.
  alignas(64) std::int32_t x[padded_capacity], y[padded_capacity];       ///< the shading position
  alignas(64) float b[2][padded_capacity];                               ///< weights of the second and third vertex
  alignas(64) float dbdx[2][padded_capacity], dbdy[2][padded_capacity];  ///< derivatives of `b`
  /// The samples that take the fragment's colour as a part of all samples of the pixel, in (0, 1]; 1 where pixels have
  /// no samples. Set where the shader needs it.
  alignas(64) float coverage[padded_capacity];

  /// `count`, rounded up to whole groups.
  int padded() const { return (count + group - 1) / group * group; }
  /// The entry that holds the values by triangle of fragment i.
  std::size_t leader(std::size_t i) const {
    return is_flat_run[i / group] ? static_cast<std::size_t>(run_begin[i / group]) * group : i;
  }
  /// The group after `first` and the rest of its run. Requires: `first` begins a run or is not flat.
  int next_run(int first) const { return is_flat_run[first] ? run_end[first] : first + 1; }
};

/// Which results of shading are required.
struct OutputMask {
  bool color = true;                                ///< false: materials and lights are not evaluated
  bool normal = false, uv = false, albedo = false;  ///< fills this array of FragmentOutputs
  bool footprint = false;                           ///< fills `mip_level` and `anisotropy` of FragmentOutputs
};

/// The results of shading a batch. Colour is linear and premultiplied; the other arrays are filled where OutputMask
/// requires them.
struct FragmentOutputs {
  alignas(64) float r[FragmentBatch::padded_capacity], g[FragmentBatch::padded_capacity];  ///< linear, premultiplied
  alignas(64) float b[FragmentBatch::padded_capacity], a[FragmentBatch::padded_capacity];  ///< linear, premultiplied
  alignas(64) float normal[3][FragmentBatch::padded_capacity];  ///< world space, unit length, towards the viewer's side
  alignas(64) float uv[2][FragmentBatch::padded_capacity];      ///< the base colour's texture coordinate
  alignas(64) float albedo[3][FragmentBatch::padded_capacity];  ///< linear base colour

  // The footprint of a pixel in the base colour's texture.
  /// log2 of its longer side, in texels of level 0; no_mip_level without a texture.
  alignas(64) float mip_level[FragmentBatch::padded_capacity];
  alignas(
      64) float anisotropy[FragmentBatch::padded_capacity];  ///< its longer axis over its shorter; 0 without a texture
  static constexpr float no_mip_level = -128;                ///< `mip_level` of a fragment without a texture
};

}  // namespace zoneplate
#pragma GCC visibility pop
