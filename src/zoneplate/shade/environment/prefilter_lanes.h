// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "zoneplate/math/lanes_vector.h"
#include "zoneplate/shade/environment/prefilter.h"

namespace zoneplate::stages {

/// The centre of a block's directions and the greatest distance of one from it, along chords of the unit sphere.
struct Cone {
  float3 centre;
  float radius;
};

[[gnu::always_inline]] inline Cone cone_of(const DirectionBlock& b) {
  const auto direction = [&](int i) { return float3{b.x[i], b.y[i], b.z[i]}; };
  float3 sum{0, 0, 0};
  for (int i = 0; i < DirectionBlock::size; ++i) sum = sum + direction(i);
  const float3 centre = normalize(sum);
  float square = 0;
  for (int i = 0; i < DirectionBlock::size; ++i) {
    const float3 away = direction(i) - centre;
    square = std::max(square, dot(away, away));
  }
  return {centre, std::sqrt(square)};
}

/// Which nodes are divided.
struct Division {
  Cone cone;
  float detail, core, width_at_horizon;
  static constexpr float horizon = 1.41421356f;  ///< the chord of a right angle

  /// The narrowest lobe requires the smallest nodes. The wider a lobe, the more light arrives from near the horizon,
  /// where it ends abruptly.
  [[gnu::always_inline]] Division(const Lobes& lobes, const DirectionBlock& block)
      : cone(cone_of(block)),
        detail(lobes.detail),
        core(std::min(2 * lobes.alpha[0], 0.7f)),
        width_at_horizon(0.08f / lobes.alpha[lobes.count - 1]) {}

  /// The least number of equal parts along each axis into which a node of this width is divided: 1 where it is taken
  /// whole, 0 where it is skipped.
  [[gnu::always_inline]] int parts(const LightTree::Node& node, float width, float prominence) const {
    const float3 away = float3{node.direction[0], node.direction[1], node.direction[2]} - cone.centre;
    const float distance = std::sqrt(dot(away, away)) - cone.radius;
    // A node is at most √2 widths long.
    const float above = horizon - (distance - 1.5f * width);
    if (above < 0) return 0;
    const bool straddles = above < 3 * width + 2 * cone.radius;
    const float limit = std::min(detail * std::max(distance, core) / prominence,
                                 straddles ? width_at_horizon / (prominence * prominence) : 1.0f);
    return width > limit ? (width > 2 * limit ? 4 : 2) : 1;
  }
};

/// The weighted sums of the directions of a block, for N lobes.
template <class F, int N>
struct LobeSums {
  static constexpr int vectors = DirectionBlock::size / F::lanes;
  Vector<F> direction[vectors], light[N][vectors];
  F weight[N][vectors], alpha2[N];

  LobeSums(const DirectionBlock& b, const Lobes& lobes) {
    for (int k = 0; k < vectors; ++k)
      direction[k] = {F::load(b.x + k * F::lanes), F::load(b.y + k * F::lanes), F::load(b.z + k * F::lanes)};
    for (int a = 0; a < N; ++a) {
      alpha2[a] = F(lobes.alpha[a] * lobes.alpha[a]);
      for (int k = 0; k < vectors; ++k) light[a][k] = {F(0.0f), F(0.0f), F(0.0f)}, weight[a][k] = F(0.0f);
    }
  }

  /// With c = n·l, (n·h)² = (1 + c) / 2 = 1 - u, where u = |n - l|² / 4: this form loses no digits near n.
  ///
  /// The mean of the lobe K over a node is K at its centre, and half of its Laplacian times the variance along an axis.
  /// Of K = (1 - 2u) / d², d = u + α² (1 - u), the Laplacian is near 2 K (3 u (1 - u) / d - (1 - 2u)) / d, and its
  /// derivative by u near -2 K / d.
  [[gnu::always_inline]] void add(const LightTree::Node& node) {
    const auto l = Vector<F>::all(node.direction), light_of_node = Vector<F>::all(node.light),
               centre = Vector<F>::all(node.centre);
    const F angle(node.solid_angle), spread(node.spread), even_spread(node.even_spread), one(1.0f);
    for (int k = 0; k < vectors; ++k) {
      const Vector<F> away = direction[k] - l;
      const F u = dot(away, away) * F(0.25f), rest = one - u, cosine = max(one - (u + u), F(0.0f));
      const F bend = F(3.0f) * u * rest, shift = dot(away, centre);
      for (int a = 0; a < N; ++a) {
        const F inverse = one / (u + alpha2[a] * rest);
        const F lobe = cosine * inverse * inverse;
        const F curvature = (bend * inverse - cosine) * inverse;
        light[a][k] = light[a][k] + light_of_node * (lobe + lobe * (curvature * spread));
        weight[a][k] = weight[a][k] + angle * (lobe + lobe * (curvature * even_spread + inverse * shift));
      }
    }
  }

  void store(RadianceBlock* out) const {
    for (int a = 0; a < N; ++a)
      for (int k = 0; k < vectors; ++k) {
        const int i = k * F::lanes;
        (light[a][k].x / weight[a][k]).store(out[a].r + i);
        (light[a][k].y / weight[a][k]).store(out[a].g + i);
        (light[a][k].z / weight[a][k]).store(out[a].b + i);
      }
  }
};

/// A walk of the tree, depth first, in an order that depends on the block alone.
template <class F, int N>
void filter_lobes(const LightTree& tree, const Lobes& lobes, const DirectionBlock& directions, RadianceBlock* out) {
  const Division division(lobes, directions);
  LobeSums<F, N> sums(directions, lobes);

  struct Place {
    int side, face, x, y;
  };
  Place stack[cube::faces + 3 * 16];
  int depth = 0;
  for (int face = cube::faces - 1; face >= 0; --face) stack[depth++] = {1, face, 0, 0};
  while (depth > 0) {
    const Place p = stack[--depth];
    const LightTree::Node& node = tree.node(p.side, p.face, p.x, p.y);
    const bool is_leaf = p.side == tree.side;
    const int parts = division.parts(node, 2 / static_cast<float>(p.side), node.prominence);
    if (parts == 1) {
      sums.add(node);
    } else if (parts > 1 && !is_leaf) {
      for (int k = 3; k >= 0; --k) stack[depth++] = {2 * p.side, p.face, 2 * p.x + k % 2, 2 * p.y + k / 2};
    } else if (parts > 1) {
      LightTree::Node in_leaf[16];
      tree.divide(p.face, p.x, p.y, parts, in_leaf);
      for (int k = 0; k < parts * parts; ++k) sums.add(in_leaf[k]);
    }
  }
  sums.store(out);
}

/// See PrefilterKernels.
template <class F>
void filter(const LightTree& tree, const Lobes& lobes, const DirectionBlock& directions, RadianceBlock* out) {
  switch (lobes.count) {
    case 1:
      return filter_lobes<F, 1>(tree, lobes, directions, out);
    case 2:
      return filter_lobes<F, 2>(tree, lobes, directions, out);
    case 3:
      return filter_lobes<F, 3>(tree, lobes, directions, out);
    case 4:
      return filter_lobes<F, 4>(tree, lobes, directions, out);
    case 5:
      return filter_lobes<F, 5>(tree, lobes, directions, out);
    default:
      return filter_lobes<F, 6>(tree, lobes, directions, out);
  }
}

}  // namespace zoneplate::stages
