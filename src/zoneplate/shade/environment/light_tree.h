// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "zoneplate/shade/environment/bordered_cube.h"

namespace zoneplate {

/// The light of a cube map as a quadtree on each face: each node has the light of the four below it, and its moments,
/// so that an integral over all directions needs small nodes only where its weight changes quickly.
///
/// Each channel has first moments of its own: where a lamp and its surroundings differ in colour, so do the centroids
/// of the channels.
struct LightTree {
  /// Means of the products of two coordinates.
  struct Squares {
    float xx, xy, yy;
  };
  struct Node {
    float direction[3];  ///< unit; the mean of the directions, weighted by the sum of the channels
    float light[3];      ///< radiance × solid angle
    float first[3][2];   ///< first moments of that about `direction`, along the vectors of Basis(direction)
    float solid_angle;
    float centre[2];             ///< the unweighted mean of the directions, in the same coordinates
    Squares of_light, of_angle;  ///< second moments about `direction`, weighted by the sum of the channels, unweighted
    float prominence;            ///< the root of its radiance relative to the mean over all directions, at least 1
    float fineness;  ///< by which its distance from a direction counts less, rising with that and with `centre`
  };
  static constexpr int max_parts = 8;  ///< of a texel along each edge, a power of two

  int side = 0;                 ///< nodes along an edge of the finest level, a power of two
  std::vector<Node> nodes;      ///< by level, from one node a face to `side` × `side`; then by face and row
  int texel_parts = max_parts;  ///< into which a walk divides a texel at most: max_parts or 1
  BorderedCube texels;          ///< of which `part` is made; not set if texels are not divided
  float mean_power = 1;         ///< sum of the channels of the mean radiance
  bool is_grey = false;         ///< the three channels are the same, in all nodes and texels

  /// The first node of the level with `level_side` nodes along an edge.
  static std::size_t offset(int level_side) {
    return 2 * (static_cast<std::size_t>(level_side) * static_cast<std::size_t>(level_side) - 1);
  }
  const Node& node(int level_side, int face, int x, int y) const {
    return nodes[offset(level_side) + static_cast<std::size_t>((face * level_side + y) * level_side + x)];
  }
  /// The light of a part of a texel, where the radiance is the quadratic B-spline whose control points are the texels.
  /// There are `parts` along each edge of a texel, a power of two; (x, y) counts parts from the corner of the face.
  Node part(int parts, int face, int x, int y) const;
  /// Sets the prominence of a node with light.
  void weigh(Node& node) const;
  /// The mean radiance over all directions.
  float3 mean() const;
};

/// Of the spline whose control points are the texels.
///
/// Requires  the side is a power of two.
LightTree make_light_tree(const CubeImage& cube);
/// Of the source of a cube map, where each texel's light has the moments of its directions. The spline is wider, by a
/// sixth of a texel's square along each axis where light is even, and by more in lamps.
///
/// Requires  the same, and there is a source.
LightTree make_light_tree_of_source(const CubeImage& cube);

}  // namespace zoneplate
