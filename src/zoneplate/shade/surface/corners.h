// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// The triangles of a range of a batch's fragments, each shaded at its three vertices or at its middle: fragments of
/// another batch.
///
/// Fragments that follow one another and have one triangle share its corners.
class TriangleCorners {
 public:
  /// `per_triangle` is 3 for the vertices, 1 for the middle.
  explicit TriangleCorners(int per_triangle) : per_triangle_(per_triangle) {}

  /// Begins anew with the fragments from `begin` on, as many as have room, and returns the first that has none.
  int collect(const FragmentBatch& fragments, int begin);

  const FragmentBatch& batch() const { return corners_; }

  /// The value at fragment i, interpolated with its weights, of an array by corner.
  float at(const FragmentBatch& fragments, int i, const float* values) const {
    const float* const corner = values + first_[i];
    if (per_triangle_ == 1) return corner[0];
    const float b1 = fragments.b[0][i], b2 = fragments.b[1][i];
    return corner[0] + ((corner[1] - corner[0]) * b1 + (corner[2] - corner[0]) * b2);
  }

 private:
  void add(const FragmentBatch& fragments, std::size_t i, float b1, float b2);

  int per_triangle_;
  FragmentBatch corners_;
  int first_[FragmentBatch::capacity] = {};  ///< the first corner of each fragment's triangle
};

}  // namespace zoneplate
