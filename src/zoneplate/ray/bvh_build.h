// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>

#include "zoneplate/base/isa.h"
#include "zoneplate/ray/bvh.h"

namespace zoneplate {

/// A box in eight lanes, by which a union is a minimum: x, y and z of its low corner and an unused lane, and the same
/// of its negated high corner. The default is empty.
struct alignas(32) BuildBox {
  static constexpr int lanes = 8, negated = 4;
  float v[lanes];

  static BuildBox empty() {
    BuildBox box;
    std::fill(std::begin(box.v), std::end(box.v), std::numeric_limits<float>::infinity());
    return box;
  }
  float low(int axis) const { return v[axis]; }
  float high(int axis) const { return -v[negated + axis]; }
  void add(const BuildBox& b) {
    for (int i = 0; i < lanes; ++i) v[i] = b.v[i] < v[i] ? b.v[i] : v[i];
  }
  /// Half of the surface area; 0 of an empty box.
  float area() const {
    const float x = high(0) - low(0), y = high(1) - low(1), z = high(2) - low(2);
    return x >= 0 ? x * y + y * z + z * x : 0;
  }
};

/// A triangle in the build, or a placement: its box, with the caster or placement and the triangle in the unused lanes.
struct BuildReference {
  BuildBox box;

  std::uint32_t caster() const { return std::bit_cast<std::uint32_t>(box.v[3]); }
  std::uint32_t triangle() const { return std::bit_cast<std::uint32_t>(box.v[7]); }
  void set(std::uint32_t caster, std::uint32_t triangle) {
    box.v[3] = std::bit_cast<float>(caster), box.v[7] = std::bit_cast<float>(triangle);
  }
  /// Twice the centroid of the box.
  float centre(int axis) const { return box.v[axis] - box.v[BuildBox::negated + axis]; }
};

/// The boxes of references, and of twice their centroids.
struct BuildBounds {
  BuildBox box = BuildBox::empty(), centres = BuildBox::empty();

  void add_centre(const BuildReference& r) {
    BuildBox c;
    for (int i = 0; i < BuildBox::negated; ++i) c.v[i] = r.centre(i), c.v[BuildBox::negated + i] = -c.v[i];
    centres.add(c);
  }
};

/// The bins of a range along each axis, over the extent of its centroids: few of small ranges, where comparing bins
/// takes longer than filling them. All centroids are in bin 0 along an axis of no extent.
struct BuildBins {
  static constexpr std::size_t capacity = 16;
  std::size_t count;
  float first[4], scale[4];  ///< the last ones are 1 and 0

  BuildBins(const BuildBox& centres, std::size_t references)
      : count(std::min(4 + references / 4, capacity)), first{0, 0, 0, 1}, scale{} {
    for (int a = 0; a < 3; ++a) {
      first[a] = centres.low(a);
      const float extent = centres.high(a) - first[a], per_unit = static_cast<float>(count) * 0.9999f / extent;
      if (extent > 0 && per_unit < std::numeric_limits<float>::infinity()) scale[a] = per_unit;
    }
  }
  std::int32_t bin_of(const BuildReference& r, int axis) const {
    const float at = (r.centre(axis) - first[axis]) * scale[axis], last = static_cast<float>(count - 1);
    return static_cast<std::int32_t>(at < last ? at : last);
  }
};

/// The division of a range by the bins along an axis.
struct BuildSplit {
  int axis = -1;         ///< -1: none, since all centroids are the same
  std::int32_t bin = 0;  ///< the first on the right
  float cost = std::numeric_limits<float>::infinity();
  BuildBox left, right;
};

/// The loops over references of which a BVH is built.
///
/// Exact     the same bits on every instruction set.
struct BuildKernels : PerIsa<BuildKernels> {
  /// Appends the references of the triangles [begin, end) of a caster whose vertices are finite to `out`, and to their
  /// bounds; returns their number.
  std::size_t (*refer)(const ShadowCaster& caster, std::uint32_t number, std::size_t begin, std::size_t end,
                       BuildReference* out, BuildBounds& bounds);
  /// The division of n references of least cost by the surface area heuristic.
  BuildSplit (*split)(const BuildReference* references, std::size_t n, const BuildBins& bins);
};

}  // namespace zoneplate
