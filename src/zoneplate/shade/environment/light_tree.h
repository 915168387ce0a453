// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "zoneplate/shade/environment/bordered_cube.h"

namespace zoneplate {

/// The light of a cube map as a quadtree on each face: each node has the light of the four below it, and its moments,
/// so that an integral over all directions needs small nodes only where its weight changes quickly.
struct LightTree {
  struct Node {
    float direction[3];  ///< unit; the mean of the directions, weighted by the light from them
    float solid_angle;
    float light[3];     ///< radiance × solid angle
    float spread;       ///< variance of the directions along one axis, weighted by the light
    float centre[3];    ///< from `direction` to the unit vector of their unweighted mean
    float even_spread;  ///< their unweighted variance about `direction` along one axis
    float prominence;   ///< the fourth root of its radiance relative to the mean over all directions, at least 1
  };
  int side = 0;             ///< nodes along an edge of the finest level, a power of two
  std::vector<Node> nodes;  ///< by level, from one node a face to `side` × `side`; then by face and row
  BorderedCube texels;

  /// The first node of the level with `level_side` nodes along an edge.
  static std::size_t offset(int level_side) {
    return 2 * (static_cast<std::size_t>(level_side) * static_cast<std::size_t>(level_side) - 1);
  }
  const Node& node(int level_side, int face, int x, int y) const {
    return nodes[offset(level_side) + static_cast<std::size_t>((face * level_side + y) * level_side + x)];
  }
  /// The light of `parts` × `parts` equal squares of a texel, by rows, where the radiance is the quadratic B-spline
  /// whose control points are the texels.
  void divide(int face, int x, int y, int parts, Node* out) const;
  /// The mean radiance over all directions.
  float3 mean() const;
};

/// Requires  the side is a power of two.
LightTree make_light_tree(const CubeImage& cube);

}  // namespace zoneplate
