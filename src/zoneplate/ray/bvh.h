// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/math/box.h"
#include "zoneplate/math/mat.h"

namespace zoneplate {

/// A node of a BVH: the boxes of up to eight children. An unused child has the box [inf, -inf], which no ray hits.
struct alignas(32) BvhNode {
  static constexpr int width = 8;
  float bound[2][3][width];    ///< low and high; x, y and z; by child
  std::uint32_t child[width];  ///< a node, or BvhNode::leaf + a leaf
  static constexpr std::uint32_t leaf = std::uint32_t{1} << 31;
};

/// Up to four triangles in world space. Unused ones have NaN as coordinates, which no ray hits.
struct alignas(64) BvhLeaf {
  static constexpr int width = 4;
  float vertex[3][3][width];  ///< by vertex; x, y and z; by triangle
  std::uint32_t instance[width], primitive[width];
  std::uint32_t translucent = 0;  ///< bit i: triangle i belongs to a translucent caster
  std::uint32_t padding[3] = {};  ///< all bytes are defined, so that trees can be compared by their bytes
};

/// Triangles of one instance that block light.
struct ShadowCaster {
  std::span<const float3> position;      ///< object space
  std::span<const std::uint32_t> index;  ///< three entries a triangle
  float4x4 world_from_object;
  bool is_translucent = false;  ///< the opacity of a hit is evaluated (trace.h)
};

/// A bounding volume hierarchy over the triangles of all casters, in world space.
///
/// Both faces of a triangle are hit. Triangles with a vertex that is not finite are left out. Vertices are transformed
/// by transform_point, so that triangles with common vertices keep common edges.
/// Exact     the same tree for any number of threads: splits depend on the triangles only.
/// Errors    OutOfMemory("shadow rays' triangles").
/// Source    binned surface area heuristic: Wald, On Fast Construction of SAH-based Bounding Volume Hierarchies, RT
///           2007; wide nodes that open the largest child first: Wald et al., Embree, SIGGRAPH 2014.
class Bvh {
 public:
  /// Built on the threads of the innermost `with_threads`.
  explicit Bvh(std::span<const ShadowCaster> casters);

  /// The root is node 0. Empty: there are no triangles.
  std::span<const BvhNode> nodes() const { return nodes_; }
  std::span<const BvhLeaf> leaves() const { return leaves_; }
  std::size_t triangles() const { return triangles_; }
  /// Of all triangles.
  Box bounds() const;

  /// The greatest number of nodes on a path from the root; bounds the stack of a traversal.
  static constexpr int max_depth = 40;

 private:
  std::vector<BvhNode> nodes_;
  std::vector<BvhLeaf> leaves_;
  std::size_t triangles_ = 0;
};

}  // namespace zoneplate
