// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/shade/environment/light_tree.h"

namespace zoneplate {

/// Lobes of GGX about a direction n, as seen along n: D(h) (n·l) with h halfway between n and l, for l above the
/// horizon. With alpha 1 it is the cosine n·l of diffuse reflection.
/// Source: Karis, Real Shading in Unreal Engine 4, SIGGRAPH 2013 (n = v = r).
struct Lobes {
  static constexpr int most = 6;
  float alpha[most];  ///< rising
  int count = 1;
  float detail = 0.28f;  ///< the greatest width of a node, relative to its distance from n or to the width of a lobe
};

/// Neighbouring directions that are filtered together.
struct DirectionBlock {
  static constexpr int size = 16;
  alignas(64) float x[size], y[size], z[size];  ///< unit length
};
struct RadianceBlock {
  alignas(64) float r[DirectionBlock::size], g[DirectionBlock::size], b[DirectionBlock::size];
};

struct PrefilterKernels : PerIsa<PrefilterKernels> {
  /// The means of the light over each lobe about each direction, in out[0] to out[count - 1]. Constant light keeps its
  /// value to rounding.
  ///
  /// Source    the division of nodes by distance, and their second moments: Barnes and Hut, A Hierarchical O(N log N)
  ///           Force-Calculation Algorithm, Nature 324, 1986; Hernquist, Performance Characteristics of Tree Codes,
  ///           Astrophysical Journal Supplement 64, 1987.
  void (*filter)(const LightTree& tree, const Lobes& lobes, const DirectionBlock& directions, RadianceBlock* out);
};

}  // namespace zoneplate
