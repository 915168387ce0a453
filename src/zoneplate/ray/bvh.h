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
  std::uint32_t child[width];  ///< a node, or one of the following + a leaf or a placement
  static constexpr std::uint32_t leaf = std::uint32_t{1} << 31, placement = leaf >> 1;
};

/// Up to four triangles. Unused ones have NaN as coordinates, which no ray hits.
struct alignas(64) BvhLeaf {
  static constexpr int width = 4;
  float vertex[3][3][width];  ///< by vertex; x, y and z; by triangle
  std::uint32_t instance[width], primitive[width];
  std::uint32_t translucent = 0;  ///< bit i: triangle i belongs to a translucent caster
  std::uint32_t padding[3] = {};  ///< all bytes are defined, so that trees can be compared by their bytes
};

/// A tree of triangles in object space that a caster has in common with others.
struct BvhPlacement {
  float world_from_object[3][4];  ///< the first three rows
  std::uint32_t root;             ///< a node
  std::uint32_t instance;
  std::uint32_t translucent;  ///< as in BvhLeaf, for each of the leaves
  std::uint32_t padding = 0;
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
///
/// Where the casters have more than `max_triangles`, a mesh that is placed often has one tree in object space.
/// Its nodes and leaves are placed in the world when rays visit them: the hits have the same bits, and take more time.
/// Exact     the same tree for any number of threads: splits depend on the triangles only.
/// Errors    OutOfMemory("shadow rays' triangles").
/// Source    binned surface area heuristic: Wald, On Fast Construction of SAH-based Bounding Volume Hierarchies, RT
///           2007; wide nodes that open the largest child first: Wald et al., Embree, SIGGRAPH 2014.
class Bvh {
 public:
  /// About 50 MB of nodes and leaves. A mesh that is placed often has its hard shadows in less time below it too, but
  /// occlusion takes a tenth more.
  static constexpr std::size_t max_expanded = std::size_t{1} << 19;

  /// Built on the threads of the innermost `with_threads`.
  explicit Bvh(std::span<const ShadowCaster> casters, std::size_t max_triangles = max_expanded);

  /// Empty: there are no triangles.
  std::span<const BvhNode> nodes() const { return nodes_; }
  std::span<const BvhLeaf> leaves() const { return leaves_; }
  std::span<const BvhPlacement> placements() const { return placements_; }
  std::uint32_t root() const { return root_; }  ///< a node
  /// Of all casters.
  std::size_t triangles() const { return triangles_; }
  /// Of all triangles.
  Box bounds() const;

  /// The greatest number of nodes on a path from the root to a leaf or a placement, or from there to a leaf; bounds the
  /// stack of a traversal.
  static constexpr int max_depth = 40;

 private:
  std::vector<BvhNode> nodes_;
  std::vector<BvhLeaf> leaves_;
  std::vector<BvhPlacement> placements_;
  std::uint32_t root_ = 0;
  std::size_t triangles_ = 0;
};

}  // namespace zoneplate
