// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "zoneplate/base/isa.h"
#include "zoneplate/ray/bvh.h"

namespace zoneplate {

/// The points origin + t direction for 0 < t < end. The direction may have any length but zero.
struct Ray {
  float origin[3];
  float direction[3];
  float end = std::numeric_limits<float>::infinity();
};

/// The point where a ray meets a triangle: the weights of the second and third vertex are b1 and b2.
struct RayHit {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t instance = none, primitive = none;
  float t = std::numeric_limits<float>::infinity();
  float b1 = 0, b2 = 0;
};

/// The opacity, in [0, 1], of a translucent caster at a hit.
struct OpacityOfHits {
  float (*opacity)(const void* context, const RayHit& hit) = nullptr;  ///< null: all casters are opaque
  const void* context = nullptr;
};

/// The tree in the form that kernels read.
struct BvhView {
  const BvhNode* nodes = nullptr;  ///< null: no triangles
  const BvhLeaf* leaves = nullptr;
  const BvhPlacement* placements = nullptr;
  std::uint32_t root = 0;
};
inline BvhView view_of(const Bvh& bvh) {
  return {bvh.nodes().empty() ? nullptr : bvh.nodes().data(), bvh.leaves().data(), bvh.placements().data(), bvh.root()};
}

/// The parts of a tree that rays of one origin can meet: nodes whose children are those of that tree's nodes.
struct BvhTop {
  static constexpr int capacity = 6;
  int count = 0;
  BvhNode nodes[capacity];
};

/// The half of a ball above a surface.
struct HalfBall {
  float origin[3];
  float normal[3];  ///< unit
  float radius;
};

/// Queries of rays against a BVH. What one ray gets does not depend on the others.
///
/// A ray through an edge or a vertex of a closed mesh hits at least one of the triangles there: vertices are sheared
/// into the ray's space, the same way for every triangle that has them, and the signs of the edge functions are exact
/// there. Boxes are tested with a margin greater than the error of the shear.
/// Exact     the same bits for every instruction set.
/// Source    Woop, Benthin and Wald, Watertight Ray/Triangle Intersection, JCGT 2013; Ize, Robust BVH Ray Traversal,
///           JCGT 2013.
struct RayKernels : PerIsa<RayKernels> {
  /// visibility[i] = the product of 1 - opacity of all triangles that ray i meets; 0 as soon as one of them is opaque.
  /// Rays that take similar ways, 32 in succession, are traced in less time.
  void (*visibility)(const BvhView& bvh, const Ray* rays, std::size_t count, const OpacityOfHits& opacity,
                     float* visibility);
  /// Sets `top` to what rays of unit length from the origin may meet in a half ball: what lies below its plane or
  /// beyond its radius by more than rounding is left out, and nodes about the origin are divided. No nodes: they meet
  /// nothing.
  void (*collect_top)(const BvhView& bvh, const HalfBall& within, BvhTop& top);
  /// The same as `visibility`, for rays from the origin of the half ball of `top` that end within its radius.
  void (*visibility_below)(const BvhView& bvh, const BvhTop& top, const Ray* rays, std::size_t count,
                           const OpacityOfHits& opacity, float* visibility);
  /// The hit of least t of each ray; of equal ones, that of the least instance and then primitive.
  void (*nearest)(const BvhView& bvh, const Ray* rays, std::size_t count, RayHit* hits);
};

}  // namespace zoneplate
